"""Trials side by side: what ``run_job`` does, many times, whatever happens to any of them."""

from collections.abc import Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from quadlab.errors import LogError
from quadlab.sweeps.job import Event, Job, JobStatus, Notice, Outcome, Started
from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.pool import run_pool
from quadlab.sweeps.progress import SilentSweep, SweepProgress
from quadlab.sweeps.warm_up import import_trials, warm_up, warm_up_trials
from quadlab.trials.config import RunOptions, TrialConfig
from quadlab.trials.identity import trial_id
from quadlab.trials.job import JobOutcome, finished_before, forget_trial, record_failure, run_job, trial_directory
from quadlab.trials.lock import held_now, is_running
from quadlab.trials.progress import SilentProgress


@dataclass(frozen=True)
class SweepTrial:
    """A trial of a sweep.

    Attributes:
        name: what tells it from the others, for people, e.g. "gait=walk seed=3".
        config: the trial.
    """

    name: str
    config: TrialConfig


@dataclass(frozen=True)
class SweepOutcome:
    """What came of a trial of a sweep.

    Attributes:
        trial: that was asked for.
        job: its files, its result or why there is none.
        wall_s: of its worker in [s]; 0 if the result was there before.
        peak_memory_mib: of its worker in [MiB]; 0 if the result was there before.
    """

    trial: SweepTrial
    job: JobOutcome
    wall_s: float = 0.0
    peak_memory_mib: float = 0.0


def run_trials(
    trials: Sequence[SweepTrial], options: RunOptions, pool: PoolConfig, progress: SweepProgress | None = None
) -> Generator[SweepOutcome, None, None]:
    """Run trials, each in a process of its own, and yield what came of them as they end.

    The results do not depend on the number of workers. A trial whose result is there already is not run again; of
    trials that are equal only the first is run. Whatever ends a worker becomes ``error.json`` in the trial's folder.
    Leaving the loop early ends all workers. With ``force`` old results go before anything runs.

    Args:
        trials: validated.
        options: of all of them.
        pool: limits.
        progress: told what happens; silent by default.

    Raises:
        PoolError: if no process can be started.
        OSError: if an old result cannot be removed.
    """
    shown = progress or SilentSweep()
    unique = unique_trials(trials, shown)
    options = without_old_results(unique, options)
    shown.begin(len(unique), pool.worker_count)
    try:
        for outcome in _outcomes(unique, options, pool, shown):
            shown.ended(outcome.trial.name, outcome.job)
            yield outcome
    finally:
        shown.end()


def unique_trials(trials: Sequence[SweepTrial], progress: SweepProgress | None = None) -> list[SweepTrial]:
    """Return the first of each set of equal trials, in the order given, and tell ``progress`` of the others.

    Under another tag a trial is another one: it leaves its files elsewhere.
    """
    found: dict[tuple[str, str], SweepTrial] = {}
    for trial in trials:
        found.setdefault((trial.config.tag, trial_id(trial.config)), trial)
    equal = len(trials) - len(found)
    if progress and equal:
        progress.notice(f"{equal} trial{'s are' if equal > 1 else ' is'} equal to others and will be run once")
    return list(found.values())


def without_old_results(trials: Sequence[SweepTrial], options: RunOptions) -> RunOptions:
    """Remove what there is of ``trials`` if they are forced, and return options to run whatever has no result.

    Of a result that is there later nobody needs to ask whether it is old: not when a worker or a machine dies, nor when
    the sweep is interrupted and goes on. A trial that another process runs now is left to it: its result will be new.

    Raises:
        OSError: if something cannot be removed.
    """
    if options.force:
        for directory in (trial_directory(trial.config, options) for trial in trials):
            if directory.is_dir():
                _forget_unless_running(directory)
    return options.model_copy(update={"force": False})


def _forget_unless_running(directory: Path) -> None:
    with held_now(directory) as busy:
        if busy is None or not is_running(directory):  # a file system without locks cannot tell
            forget_trial(directory)


def split_finished(trials: Sequence[SweepTrial], options: RunOptions) -> tuple[list[SweepOutcome], list[SweepTrial]]:
    """Return the outcomes of the trials that need not be run, and the trials that have to be.

    A result that is there but cannot be read is an outcome too: a failure, since nobody asked to replace it.
    """
    found = [(trial, _before(trial, options)) for trial in trials]
    finished = [SweepOutcome(trial, job) for trial, job in found if job is not None]
    return finished, [trial for trial, job in found if job is None]


def _outcomes(
    trials: Sequence[SweepTrial], options: RunOptions, pool: PoolConfig, shown: SweepProgress
) -> Generator[SweepOutcome, None, None]:
    finished, missing = split_finished(trials, options)
    yield from finished
    if missing:
        with closing(_run(missing, options, pool, shown)) as outcomes:
            yield from outcomes


def _before(trial: SweepTrial, options: RunOptions) -> JobOutcome | None:
    """Return the outcome of a trial that need not be run, or cannot since its result is there but unreadable."""
    try:
        return finished_before(trial.config, options)
    except LogError as error:
        return JobOutcome(trial_directory(trial.config, options), None, failure=str(error))


def _run(
    trials: Sequence[SweepTrial], options: RunOptions, pool: PoolConfig, shown: SweepProgress
) -> Generator[SweepOutcome, None, None]:
    def tell(event: Event) -> None:
        match event:
            case Started(number):
                shown.started(trials[number].name)
            case Notice(text):
                shown.notice(text)

    jobs = (Job(trial.name, run_job, (trial.config, options, SilentProgress())) for trial in trials)
    preloads = (
        Job("warming up", warm_up, (warm_up_trials(trial.config for trial in trials),)),
        Job("importing", import_trials),
    )
    shown.notice("loading")
    with closing(run_pool(jobs, pool, tell, preloads)) as outcomes:
        for outcome in outcomes:
            trial = trials[outcome.number]
            yield SweepOutcome(trial, _job(trial, options, outcome), outcome.wall_s, outcome.peak_memory_mib)


def _job(trial: SweepTrial, options: RunOptions, outcome: Outcome) -> JobOutcome:
    if outcome.status is JobStatus.RETURNED:
        job: JobOutcome = outcome.value
        return job
    if outcome.status is JobStatus.TIMED_OUT:  # perhaps it waited for another process that runs the same trial
        before = _before(trial, options)
        if before is not None:
            return before
        directory = trial_directory(trial.config, options)
        if is_running(directory):
            return JobOutcome(directory, None, failure=f"{outcome.reason}; another process runs the trial now")
    return record_failure(trial.config, options, outcome.status.value, outcome.reason, outcome.output)
