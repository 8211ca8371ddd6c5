"""Does one job of a study in its own process and keeps its row and its curves.

This module imports whatever jobs need; what only asks whether something is left to do imports ``work``.
"""

from collections.abc import Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

import quadlab.studies.jobs_kinematic
import quadlab.studies.jobs_table_one  # noqa: F401 - their jobs can be named in a study
from quadlab.errors import ConfigurationError, LogError, QuadlabError
from quadlab.studies.files import configuration_hash, last_row, remove_trace, write_row
from quadlab.studies.jobs import composes, job_named
from quadlab.studies.rows import DIRECTORY, FAILURE, LOG_HASH, Row
from quadlab.studies.traces import write_trace
from quadlab.studies.work import Work, has_plan
from quadlab.sweeps.warm_up import warm_up, warm_up_trials
from quadlab.trials.composer import Composer
from quadlab.trials.files import write_bytes
from quadlab.trials.plan_job import PLAN_FILE
from quadlab.trials.result import RESULT_FILE, TrialStatus


@lru_cache(maxsize=1)
def _composer_of(_configuration: str) -> Composer:
    """Return that of this process and of all that are forked from it: each knows what was composed before."""
    return Composer()


def warm_up_works(works: Sequence[Work]) -> None:
    """Load what the trials among ``works`` need, YAML included; for the process that workers are forked from."""
    configuration_hash()  # workers that find no file changed need not read them again
    trials = []
    for work in works:
        if work.study.job == "trial":
            with suppress(QuadlabError):  # the job itself will say it
                trials.append(composes(work.condition.overrides, _composer_of(work.configuration)))
    warm_up(warm_up_trials(trials))


def do_work(work: Work) -> Row:
    """Run the job, keep what the study asks for and return the row, which is remembered.

    A configuration that is wrong, or is another one than when the study began, is a row of status ``error``; such rows
    are not remembered.
    """
    try:
        row = _with_log_hash(work, _done(work))
    except QuadlabError as error:
        return {"status": TrialStatus.ERROR.value, FAILURE: str(error)}
    if row["status"] != TrialStatus.ERROR:
        write_row(work.folder, work.condition.identifier, work.settings, row)
    return row


def _done(work: Work) -> Row:
    """Run the job and keep what is asked for; a trial whose log is gone since is run again if its curves are."""
    row = _run(work)
    try:
        _keep(work, row)
    except LogError:
        if work.study.job != "trial":
            raise
        (work.folder.path / row[DIRECTORY] / RESULT_FILE).unlink(missing_ok=True)
        row = _run(work)
        _keep(work, row)
    return row


def _run(work: Work) -> Row:
    """Run the job between two looks at the configuration: whichever file it read is one of when the study began."""
    _check_configuration(work)
    composer = _composer_of(work.configuration)
    row = job_named(work.study.job)(work.condition.overrides, work.folder.path, composer)
    _check_configuration(work)
    return row


def _check_configuration(work: Work) -> None:
    if configuration_hash() != work.configuration:
        raise ConfigurationError("the configuration was changed while the study ran; run it again")


def _keep(work: Work, row: Row) -> None:
    """Write the curves and plans that the study asks for of this job; without a plan none of an earlier one stay."""
    if not has_plan(row):
        if row["status"] != TrialStatus.ERROR:  # of which nothing is known
            for name in (*(trace.name for trace in work.traces), *work.plans):
                remove_trace(name, work.folder)
        return
    if DIRECTORY not in row:
        return
    directory: Path = work.folder.path / row[DIRECTORY]
    for trace in work.traces:
        write_trace(trace, work.folder, directory)
    for name in work.plans:
        write_bytes(work.folder.plan(name), (directory / PLAN_FILE).read_bytes())


def _with_log_hash(work: Work, row: Row) -> Row:
    """Return a trial's row with the hash of its log, also where the log was deleted since the row was made before."""
    if LOG_HASH not in row or row[LOG_HASH] is not None:
        return row
    before = last_row(work.folder, work.condition.identifier) or {}
    same = all(before.get(key) == row[key] for key in (DIRECTORY, "state_sha256"))
    return {**row, LOG_HASH: before.get(LOG_HASH)} if same else row
