"""The subcommands of ``quadlab`` for folders of many trials: status, collect, compare, clean."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TextIO

from quadlab.command_line import EXIT_OK, EXIT_USAGE

EXIT_INCOMPLETE = 1
_FOLDER = "folder of the trials, usually results/<tag>"


def add_to(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the parsers of the subcommands."""
    _add(commands, "status", "say what is done, failed, half-written, missing or of another commit", _status)
    _add(commands, "collect", "write the results of all trials into trials.parquet and trials.csv", _collect)
    clean = _add(commands, "clean", "remove what never finished; results stay", _clean)
    clean.add_argument("--yes", action="store_true", help="do not ask")
    compare = _add(commands, "compare", "compare success and a metric between the levels of a factor", _compare)
    compare.add_argument("--by", required=True, metavar="FACTOR", help="e.g. controller, or controller.rate_hz")
    compare.add_argument("--columns", metavar="FACTOR", help="a second factor, for the columns of the tables")
    compare.add_argument("--metric", default="com_error_rms_mm", help="an outcome that is a number (%(default)s)")
    compare.add_argument("--baseline", metavar="LEVEL", help="of the factor; the first by default")


def _add(
    commands: "argparse._SubParsersAction[argparse.ArgumentParser]",
    name: str,
    help_text: str,
    action: Callable[[argparse.Namespace], int],
) -> argparse.ArgumentParser:
    command = commands.add_parser(name, help=help_text, description=help_text)
    command.add_argument("folder", type=Path, help=_FOLDER)
    command.set_defaults(action=action)
    return command


def _status(options: argparse.Namespace) -> int:
    from quadlab.analysis.sweep_status import sweep_status  # noqa: PLC0415

    status = sweep_status(options.folder)
    for line in status.lines():
        sys.stdout.write(f"{line}\n")
    return EXIT_OK if status.complete else EXIT_INCOMPLETE


def _collect(options: argparse.Namespace) -> int:
    from quadlab.analysis.collect import collect, write_collected  # noqa: PLC0415

    collection = collect(options.folder)
    table = collection.table
    parquet, csv = write_collected(table, options.folder)
    counts = ", ".join(f"{count} {status}" for status, count in table["status"].value_counts().sort_index().items())
    lines = [f"{len(table)} trials ({counts}): {parquet}, {csv}", *collection.notes()]
    sys.stdout.write("\n".join(lines) + "\n")
    return EXIT_OK


def _compare(options: argparse.Namespace) -> int:
    from quadlab.plotting.comparison_files import compare_trials  # noqa: PLC0415

    factors = [options.by] if options.columns is None else [options.by, options.columns]
    comparison = compare_trials(options.folder, factors, options.metric, options.baseline)
    sys.stdout.write(comparison.text + "\n" + "\n".join(map(str, comparison.paths)) + "\n")
    return EXIT_OK


def _clean(options: argparse.Namespace) -> int:
    from quadlab.analysis.clean import find_litter  # noqa: PLC0415

    litter = find_litter(options.folder)
    for item in litter:
        sys.stdout.write(f"{item}\n")
    if not litter:
        sys.stdout.write(f"{options.folder}: nothing that never finished\n")
        return EXIT_OK
    if not (options.yes or _confirmed(f"remove these {len(litter)}? [y/N] ", sys.stdin)):
        sys.stderr.write("quadlab: nothing was removed; --yes removes it without asking\n")
        return EXIT_USAGE
    for item in litter:
        reason = item.remove()
        if reason is not None:
            sys.stdout.write(f"left {item.directory}: {reason}\n")
    return EXIT_OK


def _confirmed(question: str, stream: TextIO) -> bool:
    if not stream.isatty():
        return False
    sys.stdout.write(question)
    sys.stdout.flush()
    return stream.readline().strip().lower() in ("y", "yes")
