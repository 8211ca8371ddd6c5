"""The command line of studies."""

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from quadlab.errors import QuadlabError, os_error_line
from quadlab.studies.config import study_names
from quadlab.studies.progress import StudyProgress
from quadlab.studies.runner import run_studies

EXIT_FAILED, EXIT_USAGE, EXIT_INTERRUPTED = 1, 2, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the studies that the arguments name and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, epilog=f"studies: {', '.join(study_names())}")
    parser.add_argument("study", nargs="+", help="name of a file in conf/study")
    parser.add_argument("--jobs", type=_positive, default=usable_cores(), help="processes at a time")
    parser.add_argument("--results", type=Path, default=Path("results"), help="folder of all results")
    options = parser.parse_args(arguments)
    progress = StudyProgress()
    try:
        errors = run_studies(options.study, options.results, options.jobs, progress)
        for name in options.study:
            report = options.results / name / "report.md"
            progress.say(f"{report}:\n{report.read_text(encoding='utf-8')}")
    except QuadlabError as error:
        for line in str(error).splitlines():
            sys.stderr.write(f"quadlab: {line}\n")
        return EXIT_USAGE
    except OSError as error:
        sys.stderr.write(f"quadlab: {os_error_line(error)}\n")
        return EXIT_FAILED
    except KeyboardInterrupt:
        sys.stderr.write("quadlab: interrupted; what is done stays, run the same command to go on\n")
        return EXIT_INTERRUPTED
    return EXIT_FAILED if errors else 0


def _positive(text: str) -> int:
    if not (text.isdecimal() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"expected a whole number above 0 (got '{text}')")
    return int(text)


def usable_cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
