"""A job of the pool, and what can come of it."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any


@dataclass(frozen=True)
class Job:
    """Something to do in a process of its own.

    Attributes:
        name: what people call it.
        function: found by its module and name, so no lambda and nothing from a script's ``__main__``.
        arguments: of the function; like what it returns they can be pickled.
    """

    name: str
    function: Callable[..., Any]
    arguments: tuple[Any, ...] = ()


class JobStatus(StrEnum):
    """How a job ended."""

    RETURNED = "returned"
    RAISED = "raised"
    """The function raised an exception."""
    DIED = "died"
    """The process ended without an answer: killed, crashed or left."""
    TIMED_OUT = "timed_out"
    """The process was killed because it ran longer than allowed."""


@dataclass(frozen=True)
class Outcome:
    """What came of a job; whatever happened in its process, it is a value and not an exception.

    Attributes:
        number: position of the job in the list.
        status: how it ended.
        value: that the function returned; None if it did not.
        reason: one line if it did not return, empty otherwise.
        output: end of what its process printed; traceback included.
        wall_s: from its start to its end in [s].
        peak_memory_mib: largest resident memory of its process in [MiB].
    """

    number: int
    status: JobStatus
    value: Any
    reason: str
    output: str
    wall_s: float
    peak_memory_mib: float


@dataclass(frozen=True)
class Started:
    """A job was given to a worker."""

    number: int


@dataclass(frozen=True)
class Notice:
    """Something that people should know and that concerns no single job."""

    text: str


Event = Started | Outcome | Notice
EventHandler = Callable[[Event], object]
