"""Who runs a trial: of two processes that want the same trial in the same folder, the second waits for the first."""

import errno
import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

LOCK_FILE = ".lock"
_NO_LOCKS = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP}
"""Some network file systems cannot lock: a trial may then be run twice at a time, into the same files."""


@contextmanager
def running(directory: Path) -> Iterator[None]:
    """Hold ``directory``, made if need be; waits while another process does.

    The kernel lets go when this process ends in any way.
    """
    with _released(directory / LOCK_FILE, _acquire(directory / LOCK_FILE)):
        yield


@contextmanager
def held_now(directory: Path) -> Iterator[str | None]:
    """Hold ``directory``, which exists, and yield None; if it cannot be had without waiting, yield one line why not."""
    path = directory / LOCK_FILE
    was_there = path.exists()
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    busy = _why_busy(descriptor, path, was_there)
    if busy is None:
        with _released(path, descriptor):
            yield None
    else:
        os.close(descriptor)
        yield busy


def is_running(directory: Path) -> bool:
    """Whether a process holds ``directory`` now; False where the file system has no locks.

    Asks for no more than to read, and disturbs nobody who asks the same.
    """
    try:
        descriptor = os.open(directory / LOCK_FILE, os.O_RDONLY)
    except FileNotFoundError:
        return False
    try:
        _lock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(descriptor)
    return False


def _why_busy(descriptor: int, path: Path, was_there: bool) -> str | None:
    """Lock an open file and return None, or why that cannot be done now."""
    try:
        locked = _lock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return "a process runs it now"
    if not locked:
        return f"no locks on its file system, and {LOCK_FILE} says that it may run" if was_there else None
    return None if _is_at(descriptor, path) else "a process has just run it"


def _acquire(path: Path) -> int:
    """Return the descriptor of the locked file at ``path``, and not of one that its last holder has just removed."""
    while True:
        path.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError):  # whoever cleans may just have removed the directory
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
            if not _lock(descriptor, fcntl.LOCK_EX) or _is_at(descriptor, path):
                return descriptor
            os.close(descriptor)


def _lock(descriptor: int, how: int) -> bool:
    """Lock an open file and return True, or False where the file system has no locks."""
    try:
        fcntl.flock(descriptor, how)
    except OSError as error:
        if error.errno not in _NO_LOCKS:
            raise
        return False
    return True


@contextmanager
def _released(path: Path, descriptor: int) -> Iterator[None]:
    """Let go of the lock at the end, and remove its file if it is still there."""
    try:
        yield
    finally:
        if _is_at(descriptor, path):  # and not that of another process, for which somebody made room
            path.unlink(missing_ok=True)
        os.close(descriptor)


def _is_at(descriptor: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), path.stat())
    except FileNotFoundError:
        return False
