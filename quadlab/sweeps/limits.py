"""What a pool may use, and how its processes are held to it (Linux)."""

import ctypes
import os
import resource
import signal
from typing import Annotated

from pydantic import Field

from quadlab.configuration import Positive, StrictModel

GIBIBYTE = 1024**3
_PR_SET_PDEATHSIG = 1
_LIBC = ctypes.CDLL(None, use_errno=True)


class PoolConfig(StrictModel):
    """What a pool may use.

    Attributes:
        workers: jobs at a time; null takes the number of usable processor cores.
        memory_limit_gib: private memory of one worker in [GiB]; null sets no limit.
        time_limit_s: wall time of one job in [s]; null sets no limit.
    """

    workers: Annotated[int, Field(ge=1)] | None
    memory_limit_gib: Positive | None
    time_limit_s: Positive | None

    @property
    def worker_count(self) -> int:
        """Jobs at a time."""
        return self.workers or usable_cores()


def usable_cores() -> int:
    """Return the number of processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def die_with(parent: int) -> None:
    """Have the kernel kill this process when its parent, whose process id is ``parent``, ends in whatever way."""
    if _LIBC.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "prctl(PR_SET_PDEATHSIG) failed")
    if os.getppid() != parent:  # it ended before we asked
        os.kill(os.getpid(), signal.SIGKILL)


def limit_memory(limit_gib: float | None) -> None:
    """Limit the private memory of this process; an allocation beyond it fails, in Python with a MemoryError."""
    if limit_gib is not None:
        size = int(limit_gib * GIBIBYTE)
        resource.setrlimit(resource.RLIMIT_DATA, (size, size))
