"""The hierarchy as Bellicoso 2016 prints it: one quadratic program a level in the null space of the levels above.

Kept as the reference that the lexicographic solver is compared with. Each program, Eq. (9)-(11), is handed to a general
solver. After a level with active inequalities the frozen set has no interior, and any solver may then fail or return
a point that is not optimal: that is seen in the residuals, counted, and the level is left as it was.
"""

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Literal, TypeAlias

import numpy as np
import qpsolvers
import scipy.linalg

from quadlab.controllers.hierarchy.level import HierarchyError, Level, stack
from quadlab.geometry.rotations import Array

QpSolver: TypeAlias = Literal["clarabel", "daqp", "osqp", "piqp", "proxqp"]

RANK_TOLERANCE = 1e-8  # singular values of A Z below this share of the norm of A do not count
REGULARISATION = 1e-9  # of the null-space coordinates, relative to the trace of Z^T A^T A Z and at least itself
OPTIMAL = 1e-4  # largest residual of the Karush-Kuhn-Tucker conditions, relative to the numbers of the program
KEPT = 1e-5  # by how much a row of norm 1 of a higher level may get worse, relative to max(1, ||x||)


class CascadeStatus(StrEnum):
    """How a cascade ended."""

    SOLVED = "solved"
    QP_FAILED = "qp_failed"


@dataclass(frozen=True)
class CascadeSolution:
    """The answer of the cascade.

    Attributes:
        x: (n,) solution; finite whatever the status.
        residual_norms: per level the norm of its slacks, in the unit of its rows.
        slacks: per level (m,), as of ``HierarchySolution``.
        programs: how many quadratic programs were solved.
        failures: reason by level whose program failed; such a level does not move ``x`` but freezes its slacks there.
        status: QP_FAILED if any did.
    """

    x: Array
    residual_norms: dict[str, float]
    slacks: dict[str, Array]
    programs: int
    failures: dict[str, str]
    status: CascadeStatus


@dataclass(frozen=True)
class _OneSided:
    """Rows of a level in the form of Eq. (8): A x = b and D x <= f."""

    equalities: Array
    target: Array
    inequalities: Array
    bound: Array


def solve_cascade(
    levels: Sequence[Level], start: Array | None = None, *, qp_solver: QpSolver = "daqp"
) -> CascadeSolution:
    """Solve the levels one after the other, Eq. (9), each in the null space of the equalities above, Eq. (12).

    Deviations from the paper: a small regularisation makes each program strictly convex, the null space is
    rank-revealing, and the result of every program is checked.

    Args:
        levels: highest priority first.
        start: (n,) where the first level begins; zeros if None.
        qp_solver: back end of ``qpsolvers``.

    Raises:
        HierarchyError: if the levels do not fit together.
    """
    dimension = stack(levels).matrix.shape[1]
    x = np.zeros(dimension) if start is None else np.array(start, dtype=np.float64)
    if x.shape != (dimension,) or not np.isfinite(x).all():
        raise HierarchyError(f"start: expected ({dimension},) finite numbers, has shape {x.shape}: {x}")
    null_space, failures, programs = np.eye(dimension), dict[str, str](), 0
    frozen, frozen_bound = np.zeros((0, dimension)), np.zeros(0)
    for level in levels:
        rows = _one_sided(level)
        if null_space.shape[1] and len(level.lower):
            programs += 1
            step = _solve_program(build_program(rows, x, null_space, frozen, frozen_bound), null_space, qp_solver)
            if isinstance(step, str) or _worsens(frozen, frozen_bound, x + step):
                failures[level.name] = step if isinstance(step, str) else "a higher level would get worse"
            else:
                x = x + step
        slack = np.maximum(rows.inequalities @ x - rows.bound, 0.0)
        frozen = np.vstack([rows.inequalities, frozen])  # newest first, Eq. (11), ...
        frozen_bound = np.concatenate([rows.bound + slack, frozen_bound])  # ... and the slacks in the same order
        null_space = null_space @ _null_space(rows.equalities @ null_space, float(np.linalg.norm(rows.equalities)))
    slacks = {level.name: level.violation(x) for level in levels}
    return CascadeSolution(
        x=x,
        residual_norms={name: math.hypot(*slack) for name, slack in slacks.items()},
        slacks=slacks,
        programs=programs,
        failures=failures,
        status=CascadeStatus.QP_FAILED if failures else CascadeStatus.SOLVED,
    )


def build_program(
    rows: _OneSided, x: Array, null_space: Array, frozen: Array, frozen_bound: Array
) -> qpsolvers.Problem:
    """Return the program of Eq. (10)-(11) in xi = [z, v]; a step of zero satisfies its frozen rows.

    Args:
        rows: of the level at hand.
        x: (n,) optimum of the levels above.
        null_space: Z, (n, k).
        frozen: D of the levels above, newest first, (m, n).
        frozen_bound: f + v* of these rows, (m,).
    """
    free, violable = null_space.shape[1], len(rows.bound)
    task = rows.equalities @ null_space
    gram = task.T @ task
    hessian = np.zeros((free + violable, free + violable))
    hessian[:free, :free] = gram + REGULARISATION * (1.0 + np.trace(gram) / free) * np.eye(free)
    hessian[free:, free:] = np.eye(violable)
    gradient = np.concatenate([task.T @ (rows.equalities @ x - rows.target), np.zeros(violable)])
    matrix = np.block(
        [
            [rows.inequalities @ null_space, -np.eye(violable)],
            [frozen @ null_space, np.zeros((len(frozen), violable))],
            [np.zeros((violable, free)), -np.eye(violable)],
        ]
    )
    bound = np.concatenate([rows.bound - rows.inequalities @ x, frozen_bound - frozen @ x, np.zeros(violable)])
    return qpsolvers.Problem(hessian, gradient, matrix, bound) if len(bound) else qpsolvers.Problem(hessian, gradient)


def _solve_program(problem: qpsolvers.Problem, null_space: Array, qp_solver: QpSolver) -> Array | str:
    """Return the step Z z, (n,), or why there is none."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a point that the back end doubts is judged below
            solution = qpsolvers.solve_problem(problem, solver=qp_solver)
    except qpsolvers.exceptions.QPError as error:
        return f"{qp_solver}: {error}"
    if not solution.found or solution.x is None or not np.isfinite(solution.x).all():
        return f"{qp_solver} found no solution"
    numbers = problem.q if problem.h is None else np.concatenate([problem.q, problem.h])
    size = 1.0 + float(np.abs(numbers).max())
    worst = max(solution.primal_residual(), solution.dual_residual()) / size
    if not worst <= OPTIMAL:
        return f"{qp_solver}: residual {worst:.1e} above {OPTIMAL:.0e}"
    return np.asarray(null_space @ solution.x[: null_space.shape[1]], dtype=np.float64)


def _one_sided(level: Level) -> _OneSided:
    equal = level.lower == level.upper
    above, below = ~equal & np.isfinite(level.upper), ~equal & np.isfinite(level.lower)
    return _OneSided(
        equalities=level.matrix[equal],
        target=level.lower[equal],
        inequalities=np.vstack([level.matrix[above], -level.matrix[below]]),
        bound=np.concatenate([level.upper[above], -level.lower[below]]),
    )


def _worsens(frozen: Array, frozen_bound: Array, after: Array) -> bool:
    """Return whether a row of a higher level is violated beyond its frozen slack after a step."""
    scale = np.linalg.norm(frozen, axis=1) * max(1.0, float(np.linalg.norm(after)))
    return bool(np.any(frozen @ after - frozen_bound > KEPT * scale))


def _null_space(matrix: Array, size: float) -> Array:
    """Return an orthonormal basis of the null space of ``matrix`` (m, k); singular values are relative to ``size``."""
    if not len(matrix):
        return np.eye(matrix.shape[1])
    if not matrix.shape[1]:
        return np.zeros((0, 0))
    _, sizes, directions = scipy.linalg.svd(matrix)
    rank = int(np.sum(sizes > RANK_TOLERANCE * size))
    return np.asarray(directions[rank:].T, dtype=np.float64)
