"""Compilation of the solver with numba, typed for the type checker."""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

_Function = TypeVar("_Function", bound=Callable[..., Any])
_FAST_MATH = {"nsz", "arcp", "contract", "reassoc", "afn"}  # keeps the meaning of NaN and infinity


def compiled(function: _Function) -> _Function:
    """Decorator: compile a function that only compiled functions call."""
    return cast(_Function, numba.njit(fastmath=_FAST_MATH, error_model="numpy")(function))


def compiled_entry(function: _Function) -> _Function:
    """Decorator: compile a function that Python calls, and keep the machine code on disk.

    numba notices a change of the file that holds ``function`` and of its closure variables, but not of the other files
    whose functions it calls. An entry point that calls any therefore has to close over
    :func:`quadlab.jit.source_fingerprint`.
    """
    return cast(_Function, numba.njit(cache=True, fastmath=_FAST_MATH, error_model="numpy")(function))
