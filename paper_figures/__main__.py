"""Redraw tables and figures from results/: ``python -m paper_figures [names ...]``, e.g. gehring2017 or figure6."""

import argparse
import sys

from paper_figures.gallery import artefact_scripts
from paper_figures.reproduction import EXIT_FAILED, EXIT_USAGE, FOLDER, draw_all, write_overviews
from paper_figures.summary import judge
from quadlab.analysis.study_results import StudyResults
from quadlab.errors import ConfigurationError
from quadlab.studies.progress import StudyProgress


def main(names: list[str]) -> int:
    """Draw the artefacts whose names contain one of ``names`` (all of them if none are given) and say where.

    Exit code 1 if results of some are missing, 2 if there is none of that name.
    """
    results = StudyResults(FOLDER.parent / "results")
    progress = StudyProgress()
    try:
        missing = draw_all(artefact_scripts(names), results, progress)
        paths = write_overviews(judge(artefact_scripts([]), results), results)
    except ConfigurationError as error:
        sys.stderr.write(f"quadlab: {error}\n")
        return EXIT_USAGE
    for path in paths:
        progress.say(str(path.relative_to(FOLDER.parent)))
    return EXIT_FAILED if missing else 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m paper_figures", description=__doc__)
    parser.add_argument("names", nargs="*", help="parts of <paper>.<script>; all artefacts if none is given")
    sys.exit(main(parser.parse_args().names))
