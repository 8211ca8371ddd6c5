"""What every method makes of one hierarchy, judged by the certificate: for comparisons, not for control."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import get_args

import numpy as np

from quadlab.controllers.hierarchy import HierarchyStatus, Level, certificate, solve_hierarchy
from quadlab.controllers.hierarchy.cascade import CascadeStatus, QpSolver, solve_cascade
from quadlab.controllers.hierarchy.daqp_hierarchical import solve_daqp_hierarchical
from quadlab.geometry.rotations import Array

LEXICOGRAPHIC, DAQP = "lexicographic", "daqp hierarchical"
CASCADES: dict[str, QpSolver] = {f"cascade, {name}": name for name in get_args(QpSolver)}
QUICK = (LEXICOGRAPHIC, DAQP)
METHODS = (*QUICK, *CASCADES)
"""Names of the methods; a cascade takes a hundred times as long as the others."""

DIFFERENT = 1e-3
"""A norm of slacks s that differs by more than this times 1 + s is another one."""


@dataclass(frozen=True)
class Opinion:
    """The answer of one method.

    Attributes:
        method: one of ``METHODS``.
        solved: whether the method says that it solved all levels.
        remainder: its certificate, largest over the levels; infinite if the answer is not finite.
        differs: whether the slacks of some level have another norm than those of the lexicographic solution.
        time_us: wall time in [us].
    """

    method: str
    solved: bool
    remainder: float
    differs: bool
    time_us: float


def opinions(levels: Sequence[Level], start: Array, methods: Sequence[str] = METHODS) -> list[Opinion]:
    """Return the opinion of each of ``methods`` on ``levels``; ``start``, (n,), is where those begin that can."""
    reference = slack_norms(levels, solve_hierarchy(levels, start).x)
    found = []
    for method in methods:
        began = time.perf_counter()
        x, solved = _solve(method, levels, start)
        time_us = 1e6 * (time.perf_counter() - began)
        finite = bool(np.isfinite(x).all())
        remainder = float(certificate(levels, x).max()) if finite else np.inf
        far = finite and np.abs(slack_norms(levels, x) - reference) > DIFFERENT * (1.0 + reference)
        found.append(Opinion(method, solved and finite, remainder, not finite or bool(np.any(far)), time_us))
    return found


def slack_norms(levels: Sequence[Level], x: Array) -> Array:
    """Return the norm of the slacks of each level at ``x``, (levels,)."""
    return np.array([np.linalg.norm(level.violation(x)) for level in levels])


def change_by_lower_levels(levels: Sequence[Level], start: Array) -> float:
    """Return the largest change that lower levels make to the slacks of a higher one, relative to 1 + their norm.

    The hierarchy is solved again and again with its last level left out.
    """
    whole, worst = slack_norms(levels, solve_hierarchy(levels, start).x), 0.0
    for count in range(1, len(levels)):
        part = slack_norms(levels[:count], solve_hierarchy(levels[:count], start).x)
        worst = max(worst, float(np.max(np.abs(whole[:count] - part) / (1.0 + part))))
    return worst


def _solve(method: str, levels: Sequence[Level], start: Array) -> tuple[Array, bool]:
    if method == LEXICOGRAPHIC:
        solution = solve_hierarchy(levels, start)
        return solution.x, solution.status is HierarchyStatus.SOLVED
    if method == DAQP:
        return solve_daqp_hierarchical(levels)
    printed = solve_cascade(levels, start, qp_solver=CASCADES[method])
    return printed.x, printed.status is CascadeStatus.SOLVED
