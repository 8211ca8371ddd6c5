"""The command line of studies."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from quadlab.command_line import EXIT_FAILED, EXIT_OK, exit_code, positive_number
from quadlab.studies.config import study_names
from quadlab.studies.progress import StudyProgress
from quadlab.studies.runner import run_studies
from quadlab.sweeps.limits import usable_cores

INTERRUPTED = "interrupted; what is done stays, run the same command to go on"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the studies that the arguments name and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, epilog=f"studies: {', '.join(study_names())}")
    parser.add_argument("study", nargs="+", help="name of a file in conf/study")
    parser.add_argument("--jobs", type=positive_number, default=usable_cores(), help="processes at a time")
    parser.add_argument("--results", type=Path, default=Path("results"), help="folder of all results")
    options = parser.parse_args(arguments)
    return exit_code(lambda: _run(options), INTERRUPTED)


def _run(options: argparse.Namespace) -> int:
    progress = StudyProgress()
    errors = run_studies(options.study, options.results, options.jobs, progress)
    for name in options.study:
        report = options.results / name / "report.md"
        progress.say(f"{report}:\n{report.read_text(encoding='utf-8')}")
    return EXIT_FAILED if errors else EXIT_OK
