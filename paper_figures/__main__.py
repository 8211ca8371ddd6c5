"""Redraw tables and figures from results/: ``python -m paper_figures [names ...] [--jobs 2]``, e.g. gehring2017."""

import argparse
import sys

from paper_figures.gallery import artefact_scripts
from paper_figures.reproduction import FOLDER, draw_all, write_overviews
from paper_figures.summary import judge
from quadlab.analysis.study_results import StudyResults
from quadlab.command_line import EXIT_FAILED, EXIT_OK, exit_code, positive_number
from quadlab.studies.progress import StudyProgress
from quadlab.sweeps.limits import usable_cores


def main(names: list[str], jobs: int) -> int:
    """Draw the artefacts whose names contain one of ``names`` (all of them if none are given) and say where.

    ``jobs`` of them are drawn at a time. Exit code 1 if results of some are missing.

    Raises:
        ConfigurationError: if there is none of that name.
    """
    results = StudyResults(FOLDER.parent / "results")
    progress = StudyProgress()
    missing = draw_all(artefact_scripts(names), results, jobs, progress)
    paths = write_overviews(judge(artefact_scripts([]), results), results)
    for path in paths:
        progress.say(str(path.relative_to(FOLDER.parent)))
    return EXIT_FAILED if missing else EXIT_OK


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m paper_figures", description=__doc__)
    parser.add_argument("names", nargs="*", help="parts of <paper>.<script>; all artefacts if none is given")
    parser.add_argument("--jobs", type=positive_number, default=usable_cores(), help="processes at a time")
    given = parser.parse_args()
    sys.exit(exit_code(lambda: main(given.names, given.jobs)))
