"""The command ``run``: one trial, or with -m a sweep on this machine, on SLURM or by any launcher of Hydra.

Exit codes: 0 every trial has a result, whatever it is; 1 the program failed in some of them; 2 the configuration is
wrong, nothing was run; 130 interrupted.
"""

import sys
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from typing import TYPE_CHECKING

from quadlab.command_line import EXIT_FAILED, EXIT_INTERRUPTED, EXIT_OK, EXIT_USAGE, complain
from quadlab.errors import ConfigurationError, QuadlabError, os_error_line
from quadlab.trials.main import run_document, run_jobs

if TYPE_CHECKING:
    from omegaconf import DictConfig

    from quadlab.sweeps.options import SweepOptions
    from quadlab.sweeps.progress import SweepProgress
    from quadlab.sweeps.trial_pool import SweepOutcome, SweepTrial
    from quadlab.trials.config import RunOptions

MULTIRUN_FLAGS = frozenset({"-m", "--multirun"})
_INTERRUPTED = "interrupted; the same command{} goes on where it stopped"
_CHECKED_FIRST = ("launcher=pool", "launcher=slurm")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run what the arguments say and return the exit code.

    Args:
        arguments: overrides and Hydra's flags; those of the process by default.
    """
    given = list(sys.argv[1:] if arguments is None else arguments)
    return run_sweep(given) if is_sweep(given) else run_jobs(given, with_sweep_checked(run_document))


def with_sweep_checked(job: "Callable[[DictConfig], int]") -> "Callable[[DictConfig], int]":
    """Return ``job``, a trial or plan alone, refusing documents that say anything wrong of sweeps."""

    def checked(document: "DictConfig") -> int:
        from quadlab.sweeps.options import sweep_options  # noqa: PLC0415

        try:
            sweep_options(document)
        except ConfigurationError as error:
            complain(str(error))
            return EXIT_USAGE
        return job(document)

    return checked


def is_sweep(arguments: Sequence[str]) -> bool:
    """Whether the arguments ask for a sweep by quadlab's own launchers, and for nothing but to run it."""
    flags = {argument for argument in arguments if argument.startswith("-")}
    by_hydra = [item for item in arguments if item.startswith(("launcher=", "hydra/")) and item not in _CHECKED_FIRST]
    return bool(flags) and flags <= MULTIRUN_FLAGS and not by_hydra


def run_sweep(arguments: Sequence[str]) -> int:
    """Check all trials of a sweep, run them side by side and return the exit code."""
    from quadlab.sweeps.terminal import terminal_sweep  # noqa: PLC0415

    sys.argv = [sys.argv[0], *arguments]
    overrides = [argument for argument in arguments if argument not in MULTIRUN_FLAGS]
    try:
        return _run(overrides, terminal_sweep())
    except ConfigurationError as error:
        complain(str(error))
        return EXIT_USAGE
    except QuadlabError as error:
        complain(str(error))
        return EXIT_FAILED
    except BrokenPipeError:  # whoever read the output has gone
        raise
    except OSError as error:
        complain(os_error_line(error))
        return EXIT_FAILED
    except KeyboardInterrupt:
        complain(_INTERRUPTED.format(""))
        return EXIT_INTERRUPTED


def _run(overrides: Sequence[str], progress: "SweepProgress") -> int:
    from quadlab.sweeps.multirun import check_sweep, sweep_points  # noqa: PLC0415
    from quadlab.sweeps.record import record_sweep  # noqa: PLC0415
    from quadlab.sweeps.trial_pool import unique_trials, without_old_results  # noqa: PLC0415

    points = sweep_points(overrides)
    progress.notice(f"checking {len(points)} trials")
    sweep = check_sweep(points, progress)
    trials = unique_trials(sweep.trials, progress)
    if sweep.options.shard:
        trials = sweep.options.shard.of(trials)
    record_sweep(sweep.trials, sweep.run)
    run = without_old_results(trials, sweep.run)
    try:
        with closing(_start(trials, run, sweep.options, progress)) as outcomes:
            failures = sum(outcome.job.result is None for outcome in outcomes)
    except KeyboardInterrupt:
        complain(_INTERRUPTED.format(" without force=true" if sweep.run.force else ""))
        return EXIT_INTERRUPTED
    return EXIT_FAILED if failures else EXIT_OK


def _start(
    trials: "Sequence[SweepTrial]", run: "RunOptions", options: "SweepOptions", progress: "SweepProgress"
) -> "Generator[SweepOutcome, None, None]":
    from quadlab.sweeps.slurm import run_on_slurm  # noqa: PLC0415
    from quadlab.sweeps.trial_pool import run_trials  # noqa: PLC0415

    if options.slurm:
        return run_on_slurm(trials, run, options.pool, options.slurm, progress)
    return run_trials(trials, run, options.pool, progress)
