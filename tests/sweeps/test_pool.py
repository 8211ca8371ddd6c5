"""What happens to one job is its own outcome: the others go on, and no process is left behind."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pool_jobs
import pytest

from quadlab.errors import PoolError
from quadlab.sweeps.job import Event, Job, JobStatus, Notice, Outcome, Started
from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.pool import run_pool

TWO = PoolConfig(workers=2, memory_limit_gib=None, time_limit_s=None)


def _jobs(function: Callable[..., object], *arguments: object) -> list[Job]:
    """Return the job between two that are fine."""
    fine = [Job(f"square {number}", pool_jobs.square, (number,)) for number in (3, 4)]
    return [fine[0], Job(function.__name__, function, arguments), fine[1]]


def _run(jobs: list[Job], config: PoolConfig = TWO) -> list[Outcome]:
    return sorted(run_pool(jobs, config), key=lambda outcome: outcome.number)


def _odd_one(function: Callable[..., object], *arguments: object, config: PoolConfig = TWO) -> Outcome:
    """Run the job between two others, expect those to return, and return its outcome."""
    before, odd, after = _run(_jobs(function, *arguments), config)
    assert (before.value, after.value) == (9, 16)
    assert odd.value is None
    return odd


def _until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.02)


def _is_gone(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().split(") ")[1][0] in "ZX"
    except FileNotFoundError:
        return True


@pytest.mark.parametrize("workers", [1, 3])
def test_every_job_returns_its_value_once(workers: int) -> None:
    jobs = [Job(str(number), pool_jobs.square, (number,)) for number in range(7)]
    outcomes = _run(jobs, TWO.model_copy(update={"workers": workers}))
    assert [outcome.number for outcome in outcomes] == list(range(7))
    assert [outcome.value for outcome in outcomes] == [number**2 for number in range(7)]
    assert {outcome.status for outcome in outcomes} == {JobStatus.RETURNED}


def test_exception_is_an_outcome() -> None:
    odd = _odd_one(pool_jobs.fail, "no such foot\nsecond line")
    assert (odd.status, odd.reason) == (JobStatus.RAISED, "ValueError: no such foot; second line")
    assert "in fail" in odd.output


def test_killed_worker_is_an_outcome_with_its_last_words() -> None:
    odd = _odd_one(pool_jobs.kill_self, signal.SIGKILL)
    assert (odd.status, odd.reason) == (JobStatus.DIED, "killed by SIGKILL")
    assert odd.output == "last words\n"


def test_crash_shows_where_it_happened() -> None:
    odd = _odd_one(pool_jobs.kill_self, signal.SIGSEGV)
    assert (odd.status, odd.reason) == (JobStatus.DIED, "killed by SIGSEGV")
    assert "in kill_self" in odd.output


def test_worker_that_leaves_is_an_outcome() -> None:
    assert _odd_one(pool_jobs.leave, 0).reason == "left with exit code 0 and without an answer"


def test_value_that_cannot_be_sent_is_an_outcome() -> None:
    odd = _odd_one(pool_jobs.make_lambda)
    assert odd.status is JobStatus.RAISED


def test_job_that_takes_too_long_is_killed() -> None:
    odd = _odd_one(pool_jobs.sleep, 60.0, config=TWO.model_copy(update={"time_limit_s": 0.5}))
    assert (odd.status, odd.reason) == (JobStatus.TIMED_OUT, "ran longer than 0.5 s")


def test_job_that_wants_too_much_memory_fails() -> None:
    odd = _odd_one(pool_jobs.allocate, 4.0, config=TWO.model_copy(update={"memory_limit_gib": 1.0}))
    assert odd.reason.startswith("MemoryError")


def test_server_that_is_killed_takes_its_workers_along_and_the_rest_goes_on() -> None:
    events: list[Event] = []
    jobs = _jobs(pool_jobs.kill_server)
    outcomes = sorted(run_pool(jobs, TWO.model_copy(update={"workers": 1}), events.append), key=lambda o: o.number)
    assert [outcome.status for outcome in outcomes] == [JobStatus.RETURNED, JobStatus.DIED, JobStatus.RETURNED]
    assert outcomes[1].reason == "the process that starts the workers was killed by SIGKILL"
    assert any(isinstance(event, Notice) for event in events)


def test_preload_that_ends_the_server_is_replaced_by_the_next() -> None:
    events: list[Event] = []
    preloads = [Job("warm-up", pool_jobs.break_preload), Job("imports", pool_jobs.square, (1,))]
    outcomes = list(run_pool(_jobs(pool_jobs.sleep, 0.0), TWO, events.append, preloads))
    assert {outcome.status for outcome in outcomes} == {JobStatus.RETURNED}
    assert Notice("warm-up: the process that starts the workers left with exit code 3") in events


def test_no_preload_that_succeeds_is_an_error() -> None:
    with pytest.raises(PoolError):
        list(run_pool(_jobs(pool_jobs.sleep, 0.0), TWO, preloads=[Job("broken", pool_jobs.break_preload)]))


def test_workers_are_forked_from_one_process() -> None:
    parents = {outcome.value for outcome in _run([Job("", pool_jobs.parent)] * 3)}
    assert len(parents) == 1
    assert os.getpid() not in parents


def test_events_tell_of_every_start_and_end() -> None:
    events: list[Event] = []
    list(run_pool(_jobs(pool_jobs.fail, "x"), TWO, events.append))
    assert sorted(event.number for event in events if isinstance(event, Started)) == [0, 1, 2]
    assert sorted(event.number for event in events if isinstance(event, Outcome)) == [0, 1, 2]


def test_leaving_early_ends_the_workers(tmp_path: Path) -> None:
    outcomes = run_pool([Job("fine", pool_jobs.square, (1,)), Job("long", pool_jobs.note_pid, (tmp_path,))], TWO)
    next(outcomes)
    _until(lambda: any(tmp_path.iterdir()))
    outcomes.close()
    assert all(_is_gone(int(path.name)) for path in tmp_path.iterdir())


def test_what_a_late_job_started_is_killed_too(tmp_path: Path) -> None:
    _odd_one(pool_jobs.start_grandchild, tmp_path, config=TWO.model_copy(update={"time_limit_s": 1.0}))
    (path,) = tmp_path.iterdir()
    _until(lambda: _is_gone(int(path.name)))


OWNER = """
import signal, sys
from pathlib import Path
import pool_jobs
from quadlab.sweeps.job import Job
from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.pool import run_pool
signal.signal(signal.SIGINT, signal.default_int_handler)  # whatever started the tests may ignore it
config = PoolConfig(workers=2, memory_limit_gib=None, time_limit_s=None)
try:
    list(run_pool([Job("", pool_jobs.note_pid, (Path(sys.argv[1]),))] * 2, config))
except KeyboardInterrupt:
    sys.exit(130)
"""


@pytest.mark.parametrize(("number", "code"), [(signal.SIGKILL, -signal.SIGKILL), (signal.SIGINT, 130)])
def test_workers_end_with_the_process_that_owns_the_pool(number: int, code: int, tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    owner = subprocess.Popen([sys.executable, "-c", OWNER, str(tmp_path)], env=environment)
    _until(lambda: len(list(tmp_path.iterdir())) == 2)
    owner.send_signal(number)
    assert owner.wait(30.0) == code
    _until(lambda: all(_is_gone(int(path.name)) for path in tmp_path.iterdir()))
