"""Compilation of inner functions with numba, typed for the type checker."""

import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba

_Function = TypeVar("_Function", bound=Callable[..., Any])


def compiled(function: _Function) -> _Function:
    """Decorator: compile an inner function; it is cached as a part of the entry point that calls it."""
    return cast(_Function, numba.njit(error_model="numpy")(function))


def inlined(function: _Function) -> _Function:
    """Decorator: as :func:`compiled`, but copied into its callers.

    For functions that are called at one place or are tiny: an argument of many arrays costs reference counting at every
    call, which takes longer than the arithmetic on a dozen numbers.
    """
    return cast(_Function, numba.njit(inline="always", error_model="numpy")(function))


def compiled_entry(function: _Function) -> _Function:
    """Decorator: compile a function that Python calls, and keep the machine code on disk.

    numba notices a change of the file that holds ``function`` and of its closure variables, but not of the other files
    whose functions it calls. An entry point that calls any therefore has to close over :func:`source_fingerprint`.
    """
    return cast(_Function, numba.njit(cache=True, error_model="numpy")(function))


def source_fingerprint(folder: Path) -> int:
    """Return a checksum over all Python files directly in ``folder``."""
    checksum = 0
    for path in sorted(folder.glob("*.py")):
        checksum = zlib.crc32(path.read_bytes(), checksum)
    return checksum
