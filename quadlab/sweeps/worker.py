"""What happens in the process of one job."""

import faulthandler
import os
import pickle
import sys
import traceback
from dataclasses import dataclass
from multiprocessing.connection import Connection
from types import TracebackType
from typing import BinaryIO, NoReturn

from quadlab.errors import QuadlabError, one_line
from quadlab.sweeps.job import Job, JobStatus
from quadlab.sweeps.limits import die_with, limit_memory


@dataclass(frozen=True)
class Answer:
    """What a worker sends before it ends.

    Attributes:
        status: RETURNED or RAISED.
        value: pickled value of the function.
        reason: one line about the exception.
    """

    status: JobStatus
    value: bytes
    reason: str


def work(pickled_job: bytes, memory_limit_gib: float | None, parent: int, answer: Connection, output: BinaryIO) -> None:
    """Run the job and send an ``Answer``; to be called in a freshly forked process.

    Args:
        pickled_job: a ``Job``.
        memory_limit_gib: of this process.
        parent: process id of the process that forked this one; this one dies with it.
        answer: where the answer goes.
        output: file that takes what the job prints.
    """
    os.setsid()  # Ctrl-C at the terminal is for the process that owns the pool
    die_with(parent)
    for stream in (1, 2):
        os.dup2(output.fileno(), stream)
    faulthandler.enable(2)
    limit_memory(memory_limit_gib)
    with _Attempt(answer):
        job: Job = pickle.loads(pickled_job)
        value = pickle.dumps(job.function(*job.arguments))
        answer.send(Answer(JobStatus.RETURNED, value, ""))


def leave() -> NoReturn:
    """End this process without what the process it was forked from would do at its end."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)


class _Attempt:
    """A context in which an exception of whatever kind becomes an answer: the border of one process."""

    def __init__(self, answer: Connection) -> None:
        self._answer = answer

    def __enter__(self) -> None:
        return None

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        if error is None:
            return False
        traceback.print_exception(error)
        self._answer.send(Answer(JobStatus.RAISED, b"", _reason(error)))
        return True


def _reason(error: BaseException) -> str:
    text = one_line(str(error))
    return text if isinstance(error, QuadlabError) else f"{type(error).__name__}: {text}"
