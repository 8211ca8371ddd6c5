"""A sweep on a SLURM cluster: a job array whose tasks run some trials each."""

import time
from collections.abc import Generator, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

from pydantic import Field

from quadlab.configuration import Positive, StrictModel
from quadlab.errors import MissingDependencyError, PoolError
from quadlab.sweeps.cell import Cell, cells
from quadlab.sweeps.interrupts import interrupts_later
from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.progress import SweepProgress
from quadlab.sweeps.slurm_queue import QueueWatch, cancel
from quadlab.sweeps.trial_pool import SweepOutcome, SweepTrial, split_finished, unique_trials, without_old_results
from quadlab.trials.config import RunOptions

if TYPE_CHECKING:
    import submitit

    Task: TypeAlias = tuple[submitit.Job[list[SweepOutcome]], Cell]

POLL_S = 2.0  # [s] between two looks at the results
QUEUE_POLL_S = 30.0  # [s] between two questions to SLURM
FOLDER = "slurm"
"""Below the results directory: scripts, answers and output of the tasks."""


class SlurmConfig(StrictModel):
    """How a sweep is given to SLURM.

    Attributes:
        trials_per_task: trials that one task runs.
        tasks_at_a_time: tasks of the array that run together at most.
        timeout_min: wall time of one task in [min].
        memory_gib: memory of one task in [GiB].
        partition, account, qos: as for sbatch; null leaves them to SLURM.
        setup: shell commands before the task.
        additional: further options of sbatch.
    """

    trials_per_task: Annotated[int, Field(ge=1)]
    tasks_at_a_time: Annotated[int, Field(ge=1)]
    timeout_min: Annotated[int, Field(ge=1)]
    memory_gib: Positive
    partition: str | None
    account: str | None
    qos: str | None
    setup: tuple[str, ...]
    additional: dict[str, str | int]


def run_on_slurm(
    trials: Sequence[SweepTrial], options: RunOptions, pool: PoolConfig, slurm: SlurmConfig, progress: SweepProgress
) -> Generator[SweepOutcome, None, None]:
    """Submit the trials that have no result yet, wait, and yield outcomes as tasks end; leaving early cancels the rest.

    Args:
        trials: validated; results go to a file system that the nodes share.
        options: of all of them.
        pool: limits within a task.
        slurm: of the job array.
        progress: told what happens.

    Raises:
        MissingDependencyError: without submitit.
        PoolError: if SLURM refuses the job or is not there.
        OSError: if an old result of a forced trial cannot be removed.
    """
    unique = unique_trials(trials, progress)
    options = without_old_results(unique, options)
    finished, missing = split_finished(unique, options)
    work = cells(missing, slurm.trials_per_task, options, pool)
    progress.begin(len(finished) + len(missing), min(len(work), slurm.tasks_at_a_time))
    try:
        for outcome in finished:
            progress.ended(outcome.trial.name, outcome.job)
            yield outcome
        with closing(_outcomes(work, Path(options.results_dir) / FOLDER, pool, slurm, progress)) as outcomes:
            for outcome in outcomes:
                progress.ended(outcome.trial.name, outcome.job)
                yield outcome
    finally:
        progress.end()


def _outcomes(
    work: Sequence[Cell], folder: Path, pool: PoolConfig, slurm: SlurmConfig, progress: SweepProgress
) -> Generator[SweepOutcome, None, None]:
    if not work:
        return
    waiting: list[Task] = []
    try:
        with interrupts_later():  # what SLURM has taken is known, and can be cancelled
            waiting = _submit(work, folder, pool, slurm)
        array = _array(waiting[0])
        progress.notice(f"submitted {len(work)} tasks as job {array}; their output is in {folder}")
        yield from _answers(waiting, QueueWatch(array, progress))
    finally:
        if waiting:
            cancel(_array(waiting[0]), progress)


def _answers(waiting: "list[Task]", watch: QueueWatch) -> Generator[SweepOutcome, None, None]:
    """Yield outcomes as tasks end, and take those tasks off the list."""
    asked_s = time.monotonic()
    while waiting:
        for task in [task for task in waiting if task[0].done()]:
            waiting.remove(task)
            yield from _answer(*task)
        if time.monotonic() - asked_s > QUEUE_POLL_S and waiting:
            waiting[0][0].watcher.update()  # asks for all of them
            gone = watch.gone([job.job_id for job, _ in waiting])
            asked_s = time.monotonic()
            for task in [task for task in waiting if task[0].job_id in gone]:
                waiting.remove(task)
                yield from _lost(*task)
        time.sleep(POLL_S)


def _array(task: "Task") -> str:
    """Return the number of the job that a task is part of."""
    number, _, _ = task[0].job_id.partition("_")
    return number


def _submit(work: Sequence[Cell], folder: Path, pool: PoolConfig, slurm: SlurmConfig) -> "list[Task]":
    try:
        import submitit  # noqa: PLC0415
    except ImportError as error:
        raise MissingDependencyError("launcher=slurm needs submitit: pip install 'quadlab[slurm]'") from error
    from submitit.core.utils import FailedJobError, FailedSubmissionError  # noqa: PLC0415

    try:
        executor = submitit.SlurmExecutor(folder=folder / "%j", max_num_timeout=0)
        executor.update_parameters(
            job_name="quadlab",
            time=slurm.timeout_min,
            mem=f"{round(1024 * slurm.memory_gib)}MB",
            cpus_per_task=pool.workers,
            array_parallelism=slurm.tasks_at_a_time,
            setup=list(slurm.setup),
            additional_parameters=slurm.additional,
            **{k: v for k in ("partition", "account", "qos") if (v := getattr(slurm, k)) is not None},
        )
        jobs = executor.map_array(Cell.run, work)
    except (RuntimeError, OSError, FailedSubmissionError, FailedJobError) as error:
        raise PoolError(f"SLURM took no job: {'; '.join(str(error).splitlines())}") from error
    return list(zip(jobs, work, strict=True))


def _answer(job: "submitit.Job[list[SweepOutcome]]", cell: Cell) -> list[SweepOutcome]:
    from submitit.core.utils import UncompletedJobError  # noqa: PLC0415

    try:
        return job.result()
    except UncompletedJobError:
        return _lost(job, cell)


def _lost(job: "submitit.Job[list[SweepOutcome]]", cell: Cell) -> list[SweepOutcome]:
    return cell.lost(f"SLURM task {job.job_id} ended without an answer: {job.state}; see {job.paths.stderr}")
