"""Does one job of a study in its own process and keeps its row and its curves.

This module imports whatever jobs need; what only asks whether something is left to do imports ``work``.
"""

import shutil
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import quadlab.studies.jobs_kinematic
import quadlab.studies.jobs_table_one  # noqa: F401 - their jobs can be named in a study
from quadlab.errors import QuadlabError
from quadlab.studies.files import write_row
from quadlab.studies.jobs import job_named
from quadlab.studies.rows import DIRECTORY, FAILURE, Row
from quadlab.studies.traces import write_trace
from quadlab.studies.work import Work, has_plan
from quadlab.sweeps.warm_up import warm_up, warm_up_trials
from quadlab.trials.compose import compose_trial
from quadlab.trials.plan_job import PLAN_FILE
from quadlab.trials.result import TrialStatus


def warm_up_works(works: Sequence[Work]) -> None:
    """Load what the trials among ``works`` need; for the process that workers are forked from."""
    trials = []
    for work in works:
        if work.study.job == "trial":
            with suppress(QuadlabError):  # the job itself will say it
                trials.append(compose_trial(work.condition.overrides))
    warm_up(warm_up_trials(trials))


def do_work(work: Work) -> Row:
    """Run the job and return its row; a configuration that is wrong is a row of status ``error``."""
    try:
        row = job_named(work.study.job)(work.condition.overrides, work.folder.path)
        _keep(work, row)
    except QuadlabError as error:
        row = {"status": TrialStatus.ERROR.value, FAILURE: str(error)}
    write_row(work.folder, work.condition.identifier, work.settings, row)
    return row


def _keep(work: Work, row: Row) -> None:
    """Write the curves and plans that the study asks for of this job, if it came so far."""
    if DIRECTORY not in row or not has_plan(row):
        return
    directory: Path = work.folder.path / row[DIRECTORY]
    for trace in work.traces:
        write_trace(trace, work.folder, directory)
    for name in work.plans:
        work.folder.plan(name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(directory / PLAN_FILE, work.folder.plan(name))
