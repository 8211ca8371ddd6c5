"""The Hydra entry point: overrides to one trial or a sweep, mistakes to one line, outcomes to exit codes.

Exit codes: 0 the trial ran (or the planner answered), whatever the outcome; 1 the program failed; 2 the configuration
is wrong.
Everything heavy is imported inside the job, so that ``--help`` and ``--cfg job`` answer at once.
"""

import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import hydra
from hydra.core.hydra_config import HydraConfig
from hydra.types import RunMode
from omegaconf import DictConfig

from quadlab.command_line import EXIT_FAILED, EXIT_INTERRUPTED, EXIT_OK, EXIT_USAGE, complain
from quadlab.errors import LogError, QuadlabError, os_error_line
from quadlab.paths import CONF_DIR
from quadlab.trials.override_problems import COMPOSITION_ERRORS, UNTYPED_COMPOSITION_ERRORS, composition_problem

if TYPE_CHECKING:
    from quadlab.planners.plan import MotionPlan


class JobFailedError(Exception):
    """Tells a sweep's launcher, which may sit in another process, that a job ended with a non-zero code."""

    def __init__(self, exit_code: int) -> None:
        super().__init__(exit_code)
        self.exit_code = exit_code


DrawPlan: TypeAlias = "Callable[[MotionPlan, Path], object]"
"""Leaves figures of a plan in a folder."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run what the arguments say and return the exit code.

    Args:
        arguments: overrides and Hydra's flags; those of the process by default.
    """
    return run_jobs(arguments, run_document)


def run_jobs(arguments: Sequence[str] | None, job: Callable[[DictConfig], int]) -> int:
    """Compose the configuration of each job that the arguments ask for, run it and return the worst exit code.

    Args:
        arguments: overrides and Hydra's flags; those of the process by default.
        job: takes a composed configuration, not validated, and returns its exit code.
    """
    if arguments is not None:
        sys.argv = [sys.argv[0], *arguments]
    os.environ.setdefault("HYDRA_FULL_ERROR", "1")  # exceptions come here instead of being printed by Hydra
    codes: list[int] = []

    def task(document: DictConfig) -> None:
        """Run one job; a sweep learns of a failure by an exception."""
        codes.append(EXIT_FAILED)
        if _in_the_commands_folder():
            codes[-1] = job(document)
        if codes[-1] != EXIT_OK and HydraConfig.get().mode == RunMode.MULTIRUN:
            raise JobFailedError(codes[-1])

    try:
        hydra.main(version_base="1.3", config_path=str(CONF_DIR), config_name="trial")(task)()
    except JobFailedError as error:
        return error.exit_code
    except KeyboardInterrupt:
        complain("interrupted")
        return EXIT_INTERRUPTED
    except BrokenPipeError:  # whoever read the output has gone
        raise
    except COMPOSITION_ERRORS as error:
        complain(composition_problem(error))
        return EXIT_USAGE
    except UNTYPED_COMPOSITION_ERRORS as error:
        if codes:  # a job had begun: this is no mistake in an override
            raise
        complain(composition_problem(error))
        return EXIT_USAGE
    return max(codes, default=EXIT_OK)


def _in_the_commands_folder() -> bool:
    """Go where the command was run, since relative paths begin there and a launcher may begin a job elsewhere."""
    folder = HydraConfig.get().runtime.cwd
    try:
        os.chdir(folder)
    except OSError as error:
        complain(f"{folder}: {error.strerror}; machines that share a sweep need the folder where it was begun")
        return False
    return True


def run_document(document: DictConfig) -> int:
    """Validate and run one composed configuration, print what came of it and return the exit code."""
    from quadlab.trials.compose import split_document  # noqa: PLC0415
    from quadlab.trials.job import run_job  # noqa: PLC0415
    from quadlab.trials.progress import terminal_progress  # noqa: PLC0415
    from quadlab.trials.report import job_report  # noqa: PLC0415

    try:
        outcome = run_job(*split_document(document), terminal_progress())
    except LogError as error:
        complain(str(error))
        return EXIT_FAILED
    except QuadlabError as error:
        complain(str(error))
        return EXIT_USAGE
    except OSError as error:
        complain(os_error_line(error))
        return EXIT_FAILED
    if outcome.failure:
        complain(outcome.failure)
        return EXIT_FAILED
    sys.stdout.write(job_report(outcome))
    return EXIT_OK


def plan_document(document: DictConfig, draw: DrawPlan) -> int:
    """Validate one composed configuration, plan, draw the plan, print what came of it and return the exit code."""
    from quadlab.trials.compose import split_document  # noqa: PLC0415
    from quadlab.trials.plan_job import run_plan_job  # noqa: PLC0415
    from quadlab.trials.plan_report import plan_report  # noqa: PLC0415

    try:
        job = run_plan_job(*split_document(document))
        if job.outcome.plan is not None:
            draw(job.outcome.plan, job.directory)
    except QuadlabError as error:
        complain(str(error))
        return EXIT_USAGE
    except OSError as error:
        complain(os_error_line(error))
        return EXIT_FAILED
    sys.stdout.write(plan_report(job))
    return EXIT_OK
