"""Redraw tables and figures from results/: ``python -m paper_figures [names ...]``, e.g. gehring2017 or figure6."""

import sys

from paper_figures.gallery import artefact_scripts
from paper_figures.reproduction import FOLDER, draw_all, write_overviews
from quadlab.analysis.study_results import StudyResults
from quadlab.studies.progress import StudyProgress


def main(names: list[str]) -> int:
    """Draw the artefacts whose names contain one of ``names`` (all of them if none are given) and say where."""
    results = StudyResults(FOLDER.parent / "results")
    progress = StudyProgress()
    missing = draw_all(artefact_scripts(names), results, progress)
    for path in write_overviews(results):
        progress.say(str(path.relative_to(FOLDER.parent)))
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
