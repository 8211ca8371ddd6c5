"""What one condition of a study can be: from its overrides to a flat row."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeAlias

from quadlab.errors import ConfigurationError
from quadlab.paths import checkout_dir
from quadlab.planners.plan import MotionPlan
from quadlab.studies.files import file_hash
from quadlab.studies.rows import DIRECTORY, FAILURE, LOG_HASH, Row
from quadlab.trials.compose import split_document
from quadlab.trials.composer import Composer
from quadlab.trials.config import RunOptions, TrialConfig
from quadlab.trials.job import run_job
from quadlab.trials.manifest import MANIFEST_FILE, git_state
from quadlab.trials.plan_job import run_plan_job
from quadlab.trials.problems import suggestion
from quadlab.trials.progress import SilentProgress
from quadlab.trials.recording.topics import LOG_FILE
from quadlab.trials.result import TrialStatus

Job: TypeAlias = Callable[[Sequence[str], Path, Composer], Row]
"""Takes overrides, the study's folder and what composes; leaves files below it, returns a row with a ``status``."""

Check: TypeAlias = Callable[[Sequence[str], Composer], object]
"""Takes the overrides of a job and raises ConfigurationError if it cannot be run with them."""

JOBS: dict[str, Job] = {}
_CHECKS: dict[str, Check] = {}


def job_named(name: str) -> Job:
    """Return a job.

    Raises:
        ConfigurationError: if there is none of that name.
    """
    if name not in JOBS:
        raise ConfigurationError(f"job: unknown '{name}'; {suggestion(name, JOBS)}")
    return JOBS[name]


def check_named(name: str) -> Check:
    """Return the check of a job.

    Raises:
        ConfigurationError: if there is none of that name.
    """
    job_named(name)
    return _CHECKS[name]


def composes(overrides: Sequence[str], composer: Composer) -> TrialConfig:
    """Return the trial that the overrides describe: the check of most jobs.

    Raises:
        ConfigurationError: if they describe none.
    """
    return split_document(composer.compose(overrides))[0]


def study_job(name: str, check: Check = composes) -> Callable[[Job], Job]:
    """Function decorator: make a job selectable by ``job: <name>`` in the YAML of a study.

    Args:
        name: of the job.
        check: of its overrides, before anything runs.
    """

    def decorate(job: Job) -> Job:
        JOBS[name] = job
        _CHECKS[name] = check
        return job

    return decorate


@study_job("trial")
def trial_row(overrides: Sequence[str], folder: Path, composer: Composer) -> Row:
    """Run one closed-loop trial, unless its result is there, and return its result as a row."""
    config = composes([*overrides, "tag=trials", "log.wall_times=false"], composer)
    outcome = run_job(config, RunOptions(force=False, results_dir=str(folder)), SilentProgress())
    made_by = json.loads((outcome.directory / MANIFEST_FILE).read_text(encoding="utf-8"))["git"]
    place = {DIRECTORY: str(outcome.directory.relative_to(folder)), "commit": made_by and made_by["commit"]}
    if outcome.result is None:
        return {"status": TrialStatus.ERROR.value, FAILURE: outcome.failure, **place}
    log = outcome.directory / LOG_FILE
    return {
        **outcome.result.model_dump(mode="json", exclude={"schema_version"}),
        LOG_HASH: file_hash(log) if log.is_file() else None,
        **place,
    }


@study_job("plan")
def plan_row(overrides: Sequence[str], folder: Path, composer: Composer) -> Row:
    """Plan without a trial and return size, times, costs, residuals and the checker's verdict as a row."""
    config = composes([*overrides, "tag=plans"], composer)
    job = run_plan_job(config, RunOptions(force=False, results_dir=str(folder)))
    row: Row = {
        "status": job.outcome.status.value,
        FAILURE: job.outcome.reason,
        "robot": config.robot.name,
        "gait": config.gait.name,
        "planner": config.planner.name,
        DIRECTORY: str(job.directory.relative_to(folder)),
        "commit": current_commit(),
    }
    return row if job.outcome.plan is None else {**row, **plan_numbers(job.outcome.plan)}


def plan_numbers(plan: MotionPlan) -> Row:
    """Return what a plan's report and verdict say, one flat column each."""
    report = plan.report
    return {
        "variables": report.variables,
        "constraints": report.constraints,
        "iterations": report.iterations,
        "build_ms": report.build_ms,
        "solve_ms": report.solve_ms,
        **{f"cost_{name}": value for name, value in report.costs.items()},
        **{f"residual_{name}": value for name, value in report.residuals.items()},
        **{f"checked_{name}": value for name, value in plan.verdict.values.items()},
    }


def current_commit() -> str | None:
    """Return the commit that runs, or None outside a repository."""
    state = git_state(checkout_dir())
    return None if state is None else str(state["commit"])
