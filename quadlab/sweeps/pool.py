"""A pool of processes: one a job, some at a time; what happens in one of them cannot touch the others.

    for outcome in run_pool(jobs, config):
        ...

A job that raises, crashes, is killed, uses too much memory or takes too long is an ``Outcome`` with a reason. Leaving
the loop early, by ``break``, an exception or Ctrl-C, ends all workers; so does the end of this process.
"""

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Generator, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import islice
from multiprocessing.connection import Pipe
from types import TracebackType
from typing import Any, Self

from quadlab.errors import PoolError
from quadlab.sweeps.fork_server import Request, Setup
from quadlab.sweeps.job import EventHandler, Job, JobStatus, Notice, Outcome, Started
from quadlab.sweeps.limits import PoolConfig

NO_PRELOAD = Job("nothing", int)
LEAVE_S = 2.0  # [s] for the server to end its workers before it is killed, and they with it

_SERVER = "from quadlab.sweeps.fork_server import main; main({control}, {parent})"
_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Forking needs a process with one thread, and small matrices gain nothing from more."""


class ServerEnded(Exception):  # noqa: N818 - an event, not an error
    """The fork server ended, and its workers with it."""


def run_pool(
    jobs: Iterable[Job],
    config: PoolConfig,
    on_event: EventHandler = lambda _: None,
    preloads: Sequence[Job] = (NO_PRELOAD,),
) -> Generator[Outcome, None, None]:
    """Run jobs side by side and yield their outcomes as they end.

    Args:
        jobs: taken one by one when a worker is free.
        config: limits.
        on_event: told when a job starts and ends, and of anything unusual.
        preloads: the first is run in the process that all workers are forked from, so that they find everything
            imported and compiled; if that process does not survive it, the next one is tried.

    Raises:
        PoolError: if it survives none of them.
    """
    waiting, untried = enumerate(jobs), list(preloads)
    while untried:
        with ForkServerProcess(config, untried[0]) as server:
            try:
                server.prepare()
            except ServerEnded as end:
                on_event(Notice(f"{untried.pop(0).name}: {end}"))
                continue
            for outcome in _serve(server, waiting, config.worker_count, on_event):
                on_event(outcome)
                yield outcome
            if not server.ended:
                return
    raise PoolError("workers cannot be started; see the messages above")


def _serve(
    server: "ForkServerProcess", waiting: Iterator[tuple[int, Job]], workers: int, on_event: EventHandler
) -> Iterator[Outcome]:
    """Keep all workers of one server busy until no job is left or the server ends, its workers with it."""
    try:
        while True:
            for number, job in islice(waiting, workers - len(server.running)):
                on_event(Started(number))
                server.start(number, job)
            if not server.running:
                return
            yield server.next_outcome()
    except ServerEnded as end:
        on_event(Notice(f"{end}; starting another"))
        for number in sorted(server.running):
            yield Outcome(number, JobStatus.DIED, None, str(end), "", 0.0, 0.0)


class ForkServerProcess:
    """The fork server as seen from the pool; a context, at whose end no process is left.

    Attributes:
        running: numbers of the jobs that were given to workers.
        ended: whether it ended by itself.
    """

    def __init__(self, config: PoolConfig, preload: Job) -> None:
        self.running: set[int] = set()
        self.ended = False
        self._connection, theirs = Pipe()
        self._setup = Setup(config, sys.argv, pickle.dumps(preload))
        code = _SERVER.format(control=theirs.fileno(), parent=os.getpid())
        paths = os.pathsep.join(path for path in sys.path if path)
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-u", "-c", code],
            stdin=subprocess.DEVNULL,
            pass_fds=[theirs.fileno()],
            env={**os.environ, **_ONE_THREAD, "PYTHONPATH": paths},
            start_new_session=True,  # Ctrl-C at the terminal is for this process alone
        )
        theirs.close()

    def prepare(self) -> None:
        """Wait until the server has loaded everything."""
        self._send(self._setup)
        self._receive()

    def start(self, number: int, job: Job) -> None:
        """Give a job to a worker of its own."""
        self.running.add(number)
        self._send(Request(number, pickle.dumps(job)))

    def next_outcome(self) -> Outcome:
        """Wait for a worker to end."""
        outcome: Outcome = self._receive()
        self.running.remove(outcome.number)
        value = pickle.loads(outcome.value) if outcome.status is JobStatus.RETURNED else None
        return replace(outcome, value=value)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._connection.close()
        try:
            self._process.wait(LEAVE_S)
        except subprocess.TimeoutExpired:  # it is still loading
            self._process.kill()
            self._process.wait()

    def _send(self, message: Setup | Request) -> None:
        try:
            self._connection.send(message)
        except OSError as error:
            raise self._end() from error

    def _receive(self) -> Any:
        try:
            return self._connection.recv()
        except (EOFError, OSError) as error:
            raise self._end() from error

    def _end(self) -> ServerEnded:
        self.ended = True
        code = self._process.wait()
        how = f"was killed by {signal.Signals(-code).name}" if code < 0 else f"left with exit code {code}"
        return ServerEnded(f"the process that starts the workers {how}")
