"""One job of a study in its own process: run it, keep its row and its curves."""

import shutil
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import quadlab.studies.jobs_kinematic
import quadlab.studies.jobs_table_one  # noqa: F401 - their jobs can be named in a study
from quadlab.errors import QuadlabError
from quadlab.studies.condition import Condition
from quadlab.studies.config import StudyConfig, TraceConfig
from quadlab.studies.files import StudyFolder, configuration_hash, read_row, write_row
from quadlab.studies.jobs import DIRECTORY, FAILURE, job_named
from quadlab.studies.traces import trace_files, write_trace
from quadlab.sweeps.warm_up import warm_up, warm_up_trials
from quadlab.trials.compose import compose_trial
from quadlab.trials.plan_job import PLAN_FILE
from quadlab.trials.result import RESULT_FILE, TrialStatus


@dataclass(frozen=True)
class Work:
    """A job to be done.

    Attributes:
        study: that it belongs to.
        folder: of the study.
        condition: to run.
    """

    study: StudyConfig
    folder: StudyFolder
    condition: Condition

    @property
    def settings(self) -> str:
        """What the row depends on besides the overrides."""
        return f"{self.study.job} {configuration_hash()}"

    @property
    def traces(self) -> list[TraceConfig]:
        """Which curves are kept of it."""
        return [trace for trace in self.study.traces if self.condition.matches(trace.where)]

    @property
    def plans(self) -> list[str]:
        """Under which names its plan is kept."""
        return [name for name, where in self.study.plans.items() if self.condition.matches(where)]


def remembered(work: Work) -> dict[str, Any] | None:
    """Return the row of a job that was done before and whose files are all there, else None."""
    row = read_row(work.folder, work.condition.identifier, work.settings)
    if row is None or row["status"] == TrialStatus.ERROR:
        return None
    needed = [path for trace in work.traces for path in trace_files(trace, work.folder)]
    needed += [work.folder.plan(name) for name in work.plans]
    if work.study.job == "trial":
        needed.append(work.folder.path / row[DIRECTORY] / RESULT_FILE)
    return row if all(path.is_file() for path in needed) else None


def warm_up_works(works: Sequence[Work]) -> None:
    """Load what the trials among ``works`` need; for the process that workers are forked from."""
    trials = []
    for work in works:
        if work.study.job == "trial":
            with suppress(QuadlabError):  # the job itself will say it
                trials.append(compose_trial(work.condition.overrides))
    warm_up(warm_up_trials(trials))


def do_work(work: Work) -> dict[str, Any]:
    """Run the job and return its row; a configuration that is wrong is a row of status ``error``."""
    try:
        row = job_named(work.study.job)(work.condition.overrides, work.folder.path)
        _keep(work, row)
    except QuadlabError as error:
        row = {"status": TrialStatus.ERROR.value, FAILURE: str(error)}
    write_row(work.folder, work.condition.identifier, work.settings, row)
    return row


def _keep(work: Work, row: dict[str, Any]) -> None:
    """Write the curves and plans that the study asks for of this job."""
    if DIRECTORY not in row:
        return
    directory: Path = work.folder.path / row[DIRECTORY]
    for trace in work.traces:
        write_trace(trace, work.folder, directory)
    for name in work.plans:
        work.folder.plan(name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(directory / PLAN_FILE, work.folder.plan(name))
