"""The process that workers are forked from.

It loads what is heavy once, keeps a single thread, so that forking is safe, and watches its children. It ends them when
the pool closes the connection or a job takes too long, and dies with the pool.
"""

import gc
import os
import pickle
import signal
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any, BinaryIO

from quadlab.sweeps.job import Job, JobStatus, Outcome
from quadlab.sweeps.limits import PoolConfig, die_with
from quadlab.sweeps.worker import Answer, leave, work

OUTPUT_TAIL = 4000  # [B] of what a job printed that are kept
MEBIBYTE_IN_KIB = 1024


@dataclass(frozen=True)
class Setup:
    """The first message to the server.

    Attributes:
        config: of the pool.
        argv: of the pool's process, which provenance records.
        preload: pickled ``Job`` that is run before anything is forked.
    """

    config: PoolConfig
    argv: Sequence[str]
    preload: bytes


@dataclass(frozen=True)
class Request:
    """Asks for a worker.

    Attributes:
        number: of the job.
        pickled_job: a ``Job``.
    """

    number: int
    pickled_job: bytes


@dataclass(frozen=True)
class Child:
    """A running worker.

    Attributes:
        request: that it works on.
        pid: process id; it leads a process group of its own.
        answer: where its answer comes from; closed when it ends.
        output: what it prints, a file without a name.
        began_s: monotonic time in [s].
    """

    request: Request
    pid: int
    answer: Connection
    output: BinaryIO
    began_s: float


def main(control: int, parent: int) -> None:
    """Serve the pool whose process id is ``parent`` over the socket ``control`` until it closes it."""
    die_with(parent)
    connection = Connection(control)
    setup: Setup = connection.recv()
    sys.argv = list(setup.argv)
    preload: Job = pickle.loads(setup.preload)
    preload.function(*preload.arguments)
    gc.freeze()  # what is there now stays: no need to copy its pages into every worker
    connection.send(None)
    ForkServer(connection, setup.config).serve()


class ForkServer:
    """Forks a worker a request and reports how it ended."""

    def __init__(self, connection: Connection, config: PoolConfig) -> None:
        self._connection = connection
        self._config = config
        self._children: dict[Connection, Child] = {}

    def serve(self) -> None:
        """Answer requests until the connection is closed, then end all workers."""
        while True:
            ready = wait([self._connection, *self._children], self._patience())
            for channel in ready:
                if channel is not self._connection:
                    self._report(self._children[channel], None)  # type: ignore[index]
            self._end_late()
            if self._connection in ready:
                try:
                    self._fork(self._connection.recv())
                except EOFError:
                    return self._end_all()

    def _fork(self, request: Request) -> None:
        receiver, sender = _pipe()
        output = os.fdopen(os.memfd_create("output"), "rb+")
        server = os.getpid()
        began_s = time.monotonic()
        pid = os.fork()
        if pid == 0:
            for connection in (self._connection, receiver, *self._children):
                connection.close()
            work(request.pickled_job, self._config.memory_limit_gib, server, sender, output)
            leave()
        sender.close()
        self._children[receiver] = Child(request, pid, receiver, output, began_s)

    def _patience(self) -> float | None:
        """Return how long no worker runs out of time, in [s]."""
        limit = self._config.time_limit_s
        if limit is None or not self._children:
            return None
        return max(0.0, min(child.began_s for child in self._children.values()) + limit - time.monotonic())

    def _end_late(self) -> None:
        limit = self._config.time_limit_s
        for child in list(self._children.values()):
            if limit is not None and time.monotonic() - child.began_s >= limit:
                _kill(child.pid)
                self._report(child, f"ran longer than {limit:g} s")

    def _end_all(self) -> None:
        for child in self._children.values():
            _kill(child.pid)
        for child in self._children.values():
            os.waitpid(child.pid, 0)

    def _report(self, child: Child, late: str | None) -> None:
        """Wait for the end of a worker that has answered, died or been killed, and tell the pool."""
        answer = _answer_of(child)
        _, wait_status, usage = os.wait4(child.pid, 0)
        del self._children[child.answer]
        child.answer.close()
        if answer is None:
            status = JobStatus.TIMED_OUT if late else JobStatus.DIED
            answer = Answer(status, b"", late or _cause(wait_status))
        output = "" if answer.status is JobStatus.RETURNED else _tail(child.output)
        child.output.close()
        wall_s, peak_mib = time.monotonic() - child.began_s, usage.ru_maxrss / MEBIBYTE_IN_KIB
        number = child.request.number
        outcome = Outcome(number, answer.status, answer.value, answer.reason, output, wall_s, peak_mib)
        self._connection.send(outcome)


def _pipe() -> tuple[Connection, Connection]:
    receiver, sender = os.pipe()
    return Connection(receiver, writable=False), Connection(sender, readable=False)


def _answer_of(child: Child) -> Answer | None:
    try:
        answer: Any = child.answer.recv()
    except (EOFError, OSError, pickle.UnpicklingError):  # it ended before it had said everything
        return None
    return answer if isinstance(answer, Answer) else None


def _kill(pid: int) -> None:
    """Kill a worker and all that it started."""
    os.kill(pid, signal.SIGKILL)
    try:
        os.killpg(pid, signal.SIGKILL)
    except ProcessLookupError:
        return  # it had not yet begun its group


def _cause(wait_status: int) -> str:
    """Return in one line how a process ended."""
    if os.WIFSIGNALED(wait_status):
        return f"killed by {signal.Signals(os.WTERMSIG(wait_status)).name}"
    return f"left with exit code {os.WEXITSTATUS(wait_status)} and without an answer"


def _tail(output: BinaryIO) -> str:
    end = output.seek(0, os.SEEK_END)
    output.seek(max(0, end - OUTPUT_TAIL))
    return output.read().decode(errors="replace")
