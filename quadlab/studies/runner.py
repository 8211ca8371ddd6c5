"""Runs studies: all their jobs through one pool, searches included, then their tables and reports."""

from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

from quadlab.studies.boundary import BoundarySearch
from quadlab.studies.condition import Condition, conditions
from quadlab.studies.config import StudyConfig, load_study
from quadlab.studies.files import StudyFolder
from quadlab.studies.jobs import FAILURE, job_named
from quadlab.studies.progress import StudyProgress
from quadlab.studies.tables import write_tables
from quadlab.studies.work import Work, do_work, remembered, warm_up_works
from quadlab.sweeps.job import Job, JobStatus, Outcome
from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.pool import NO_PRELOAD, run_pool
from quadlab.trials.result import TrialStatus

Row = dict[str, Any]


@dataclass
class OpenCondition:
    """A condition under way: one job, or a search that asks for one after the other."""

    condition: Condition
    search: BoundarySearch | None
    rows: list[tuple[Condition, Row]] = field(default_factory=list)

    @property
    def levels_of_parts(self) -> tuple[object, ...]:
        """Which planner, controller and estimator it asks for by name; they are loaded once for all jobs."""
        return tuple(self.condition.levels.get(part) for part in ("planner", "controller", "estimator"))

    def next_job(self) -> Condition | None:
        """Return the job to do next; None if there is none left."""
        if self.search is None:
            return None if self.rows else self.condition
        value = self.search.next_value()
        return None if value is None else self.condition.probe(value)

    def take(self, job: Condition, row: Row) -> None:
        """Take in the row of a job."""
        self.rows.append((job, row))
        if self.search is not None:
            value = float(job.levels[self.search.config.label])
            self.search.record(value, row["status"] == TrialStatus.COMPLETED)


@dataclass
class OpenStudy:
    """A study under way."""

    name: str
    config: StudyConfig
    folder: StudyFolder
    conditions: list[OpenCondition]
    changed: bool = False

    def open_jobs(self, progress: StudyProgress) -> Iterator[tuple[OpenCondition, Condition]]:
        """Yield the first job of each condition that was not done before."""
        for condition in self.conditions:
            job = self.advance(condition, progress)
            if job is not None:
                yield condition, job

    def advance(self, condition: OpenCondition, progress: StudyProgress) -> Condition | None:
        """Return the next job of a condition that has to be done, taking in those that were done before."""
        while (job := condition.next_job()) is not None:
            progress.expect(1)
            row = remembered(self.work(job))
            if row is None:
                return job
            condition.take(job, row)
            progress.skip()
        return None

    def work(self, job: Condition) -> Work:
        """Return what a process needs to do a job."""
        return Work(self.config, self.folder, job)


PendingJob: TypeAlias = tuple[OpenStudy, OpenCondition, Condition]
"""A job with what it belongs to."""


def open_study(name: str, results: Path) -> OpenStudy:
    """Return a study that is about to be run.

    Raises:
        ConfigurationError: if there is no such study, or something in it is wrong.
    """
    config = load_study(name)
    job_named(config.job)
    opened = [OpenCondition(c, BoundarySearch(c.search) if c.search else None) for c in conditions(config)]
    return OpenStudy(name, config, StudyFolder(results / name), opened)


def run_studies(names: Sequence[str], results: Path, workers: int, progress: StudyProgress) -> int:
    """Run what is missing of some studies, write their tables, and return how many jobs ended in an error.

    Args:
        names: of the studies.
        results: folder of all results.
        workers: processes at a time.
        progress: told about every job.

    Raises:
        ConfigurationError: if a study does not exist, or something in it is wrong.
    """
    studies = [open_study(name, results) for name in names]
    queue = deque((study, *job) for study in studies for job in study.open_jobs(progress))
    if queue:
        _work_off(queue, workers, progress)
    for study in studies:
        rows = [row for condition in study.conditions for row in condition.rows]
        if study.changed or not study.folder.table.is_file():
            searches = [(c.condition, c.search) for c in study.conditions if c.search is not None]
            write_tables(study.config, study.folder, rows, searches)
    everything = [row for study in studies for condition in study.conditions for _, row in condition.rows]
    return sum(row["status"] == TrialStatus.ERROR for row in everything)


@dataclass
class JobQueue:
    """The jobs of all studies for the pool: empty for a moment while every search waits for its last probe."""

    waiting: deque[PendingJob]
    handed_out: list[PendingJob] = field(default_factory=list)

    def __iter__(self) -> "JobQueue":
        return self

    def __next__(self) -> Job:
        """Return the next job of the pool; its number is its place in ``handed_out``."""
        if not self.waiting:
            raise StopIteration
        study, condition, job = self.waiting.popleft()
        self.handed_out.append((study, condition, job))
        return Job(_name(study, job), do_work, (study.work(job),))


def _work_off(waiting: deque[PendingJob], workers: int, progress: StudyProgress) -> None:
    """Do all jobs, each followed by what its search asks for next."""
    first = {(study.name, condition.levels_of_parts): study.work(job) for study, condition, job in reversed(waiting)}
    preloads = (Job("warming up", warm_up_works, (list(first.values()),)), NO_PRELOAD)
    queue = JobQueue(waiting)
    pool = PoolConfig(workers=workers, memory_limit_gib=None, time_limit_s=None)
    with closing(run_pool(queue, pool, preloads=preloads)) as outcomes:
        for outcome in outcomes:
            study, condition, job = queue.handed_out[outcome.number]
            row = outcome.value if outcome.status is JobStatus.RETURNED else _failed(outcome)
            condition.take(job, row)
            study.changed = True
            progress.finish(_name(study, job), row)
            following = study.advance(condition, progress)
            if following is not None:
                queue.waiting.appendleft((study, condition, following))


def _failed(outcome: Outcome) -> Row:
    """Return the row of a job whose process ended without one; it is not remembered."""
    return {"status": TrialStatus.ERROR.value, FAILURE: outcome.reason}


def _name(study: OpenStudy, job: Condition) -> str:
    return f"{study.name} {', '.join(str(level) for level in job.levels.values())}"
