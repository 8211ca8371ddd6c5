"""Does the jobs of studies in a pool of processes; imports what jobs need."""

from collections import deque
from contextlib import closing
from dataclasses import dataclass, field

from quadlab.studies.open_study import PendingJob
from quadlab.studies.progress import StudyProgress
from quadlab.studies.rows import FAILURE, Row
from quadlab.studies.worker import do_work, warm_up_works
from quadlab.sweeps.job import Event, Job, JobStatus, Notice, Outcome
from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.pool import NO_PRELOAD, run_pool
from quadlab.trials.manifest import note_code
from quadlab.trials.result import TrialStatus


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
        return Job(study.job_name(job), do_work, (study.work(job),))


def work_off(waiting: deque[PendingJob], workers: int, progress: StudyProgress) -> None:
    """Do all jobs, which were checked, each followed by what its search asks for next."""
    note_code()
    first = {(study.name, condition.levels_of_parts): study.work(job) for study, condition, job in reversed(waiting)}
    preloads = (Job("warming up", warm_up_works, (list(first.values()),)), NO_PRELOAD)
    queue = JobQueue(waiting)
    pool = PoolConfig(workers=workers, memory_limit_gib=None, time_limit_s=None)
    with closing(run_pool(queue, pool, lambda event: _say_notice(event, progress), preloads)) as outcomes:
        for outcome in outcomes:
            study, condition, job = queue.handed_out[outcome.number]
            row = outcome.value if outcome.status is JobStatus.RETURNED else _failed(outcome)
            condition.take(job, row)
            progress.finish(study.job_name(job), row)
            following = study.advance(condition, progress)
            if following is not None:
                queue.waiting.appendleft((study, condition, following))


def _say_notice(event: Event, progress: StudyProgress) -> None:
    """Print what concerns no single job, such as workers that cannot be started."""
    if isinstance(event, Notice):
        progress.say(event.text)


def _failed(outcome: Outcome) -> Row:
    """Return the row of a job whose process ended without one; it is not remembered."""
    return {"status": TrialStatus.ERROR.value, FAILURE: outcome.reason}
