"""The console command ``quadlab``: run trials or plan alone, look at what they left, rescue a log."""

import argparse
import sys
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path

from quadlab import __version__, sweep_commands
from quadlab.command_line import exit_code

_EPILOG = """
quadlab run --help lists what can be overridden. Without a command, quadlab runs a trial:
quadlab gait=walk seed=3 is quadlab run gait=walk seed=3.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code.

    Args:
        arguments: without the program's name; those of the process by default.
    """
    given = list(sys.argv[1:] if arguments is None else arguments)
    return exit_code(lambda: _answer(given))


def _answer(given: Sequence[str]) -> int:
    """Do what the arguments ask for; everything heavy is imported in here."""
    if given and given[0] == "run":
        return _run(given[1:])
    if given and given[0] == "plan":
        return _plan(given[1:])
    if _is_override(given):
        return _run(given)
    options = _parser().parse_args(given)
    action: Callable[[argparse.Namespace], int] = options.action
    return action(options)


def _is_override(given: Sequence[str]) -> bool:
    """Whether the arguments are those of ``run`` with the word left out."""
    return any("=" in argument for argument in given[:1]) or given[:1] == ["-m"] or given[:1] == ["--multirun"]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("quadlab", description=__doc__, epilog=_EPILOG)
    parser.add_argument("--version", action="version", version=f"quadlab {__version__}")
    commands = parser.add_subparsers(required=True, metavar="command")
    commands.add_parser("run", help="run a trial, or with -m a sweep: overrides such as robot=anymal_b gait=trot")
    commands.add_parser("plan", help="plan without running: the same overrides")
    sweep_commands.add_to(commands)
    for name, help_text, what, action in (
        ("plot", "draw the figures of a trial", "directory of the trial", _plot),
        ("render", "make a video of a trial", "directory of the trial", _render),
        ("recover", "rescue the log of a trial that was killed", "the .mcap.part file", _recover),
    ):
        command = commands.add_parser(name, help=help_text)
        command.add_argument("path", type=Path, help=what)
        command.set_defaults(action=partial(_print, action))
    return parser


def _print(action: Callable[[Path], Iterable[object]], options: argparse.Namespace) -> int:
    for line in action(options.path):
        sys.stdout.write(f"{line}\n")
    return 0


def _run(overrides: Sequence[str]) -> int:
    from quadlab.sweeps.main import main as run_main  # noqa: PLC0415

    return run_main(overrides)


def _plan(overrides: Sequence[str]) -> int:
    from quadlab.plotting.plan_files import main as plan_main  # noqa: PLC0415

    return plan_main(overrides)


def _plot(directory: Path) -> Iterable[Path]:
    from quadlab.plotting.trial_figures import plot_trial  # noqa: PLC0415

    return plot_trial(directory)


def _render(directory: Path) -> Iterable[Path]:
    from quadlab.plotting.trial_video import render_trial_log  # noqa: PLC0415

    rendered = render_trial_log(directory)
    return [rendered.video, rendered.strip]


def _recover(part: Path) -> Iterable[str]:
    from quadlab.trials.recording.recover import default_target, recover_log  # noqa: PLC0415

    target = default_target(part)
    report = recover_log(part, target)
    return [f"{target}: {report.messages} messages up to {report.last_time_s} s ({report.reason})"]
