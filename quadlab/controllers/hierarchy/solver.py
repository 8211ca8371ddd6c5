"""Hierarchical least squares with words at the border: named levels in, a named solution out."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from quadlab.controllers.hierarchy.level import HierarchyError, Level, SideArray, stack
from quadlab.controllers.hierarchy.stacked import solve_stacked
from quadlab.geometry.rotations import Array


class HierarchyStatus(StrEnum):
    """How a solve ended."""

    SOLVED = "solved"
    ITERATION_LIMIT = "iteration_limit"
    BREAKDOWN = "numerical_breakdown"


_STATUS_OF_CODE = (HierarchyStatus.SOLVED, HierarchyStatus.ITERATION_LIMIT, HierarchyStatus.BREAKDOWN)


@dataclass(frozen=True)
class HierarchySolution:
    """The answer of the hierarchical solver.

    Attributes:
        x: (n,) solution; finite whatever the status.
        residual_norms: per level the norm of its slacks, in the unit of its rows.
        slacks: per level (m,): matrix @ x - b for equalities; for inequalities by how much the row lies above
            (positive) or below (negative) its interval, 0 if satisfied.
        active: per level (m,) int8: 2 equality, +1 at or above the upper bound, -1 at or below the lower bound, 0
            strictly between.
        iterations: active-set iterations over all levels.
        status: how the solve ended. Unless it is SOLVED, ``x`` is optimal only for the levels that were finished.
    """

    x: Array
    residual_norms: dict[str, float]
    slacks: dict[str, Array]
    active: dict[str, SideArray]
    iterations: int
    status: HierarchyStatus


def solve_hierarchy(
    levels: Sequence[Level], start: Array | None = None, *, iteration_limit: int = 500
) -> HierarchySolution:
    """Minimise the slacks of each level in the least-squares sense, strictly subordinate to all levels before it.

    Solves the cascade of Bellicoso 2016, Eqs. (8)-(11), in one go. Among all minimisers of the hierarchy the result is
    the one closest to ``start``.

    Args:
        levels: highest priority first.
        start: (n,) warm start and reference of the last choice; zeros if None.
        iteration_limit: iterations over all levels together, at least 1.

    Raises:
        HierarchyError: if the levels do not fit together, or the start or the limit is not usable.
    """
    stacked = stack(levels)
    dimension = stacked.matrix.shape[1]
    point = np.zeros(dimension) if start is None else np.ascontiguousarray(start, dtype=np.float64)
    if point.shape != (dimension,) or not np.isfinite(point).all():
        raise HierarchyError(f"start: expected ({dimension},) finite numbers, has shape {point.shape}: {point}")
    if iteration_limit < 1:
        raise HierarchyError(f"iteration_limit: expected at least 1, is {iteration_limit}")
    result = solve_stacked(*stacked, point, iteration_limit)
    names = [level.name for level in levels]
    slack_of = dict(zip(names, np.split(result.slacks, stacked.breaks[1:-1]), strict=True))
    return HierarchySolution(
        x=result.x,
        residual_norms={name: math.hypot(*slack) for name, slack in slack_of.items()},
        slacks=slack_of,
        active=dict(zip(names, np.split(result.active, stacked.breaks[1:-1]), strict=True)),
        iterations=result.iterations,
        status=_STATUS_OF_CODE[result.status],
    )
