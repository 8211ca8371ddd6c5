"""A proof of optimality that knows nothing of the solver: multipliers for every level, from x and the levels alone.

A point x is optimal for level p among all points with the same slacks at the levels k < p exactly if there are
multipliers y (free) and nu >= 0 with

    grad_p + sum_{k<p} (E_k^T y_k + I_k^T nu_k) = 0,    grad_p = M_p^T s_p(x),

where s_p are the slacks of level p, E_k the rows of level k whose slack is fixed (equalities and violated inequalities)
and I_k its satisfied inequalities that lie at their bound, outward direction. The remainder of the best multipliers,
found by nonnegative least squares, is the certificate.
"""

from collections.abc import Sequence

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from quadlab.controllers.hierarchy.level import Level
from quadlab.geometry.rotations import Array

BoolArray = NDArray[np.bool_]

# Distance from its bound, relative to max(1, ||x||), at which a row of norm 1 counts as lying on it. It sorts the rows;
# the slacks themselves enter the gradient as they are, however small.
ACTIVITY_TOLERANCE = 1e-7
_RANK_TOLERANCE = 1e-9
_NEGLIGIBLE_GRADIENT = 1e-9


def certificate(levels: Sequence[Level], x: Array) -> Array:
    """Return how far ``x`` is from optimal, level by level.

    Args:
        levels: highest priority first.
        x: (n,) the point to judge.

    Returns:
        (levels,) norm of what no multiplier can balance, relative to the rows of the level times max(1, its slacks).
        A right solution has rounding errors, 1e-15 to 1e-9; a point 1e-4 away from it has more than 1e-6; inf if the
        least-squares routine found no multipliers.
    """
    fixed_rows, active_rows = np.zeros((0, len(x))), np.zeros((0, len(x)))
    remainders = []
    for level in levels:
        slacks = level.violation(x)
        gradient = level.matrix.T @ slacks
        scale = max(1.0, float(np.linalg.norm(slacks))) * max(float(np.linalg.norm(level.matrix)), 1e-12)
        remainders.append(_unbalanced(gradient, fixed_rows, active_rows) / scale)
        fixed_rows = np.vstack([fixed_rows, level.matrix[_is_fixed(level, x)]])
        active_rows = np.vstack([active_rows, _active_directions(level, x)])
    return np.array(remainders)


def _tolerance(level: Level, x: Array) -> Array:
    tolerance: Array = ACTIVITY_TOLERANCE * max(1.0, float(np.linalg.norm(x))) * np.linalg.norm(level.matrix, axis=1)
    return tolerance


def _is_fixed(level: Level, x: Array) -> BoolArray:
    """Return which rows keep their slack: equalities and inequalities that are violated beyond the tolerance."""
    fixed: BoolArray = (level.lower == level.upper) | (np.abs(level.violation(x)) > _tolerance(level, x))
    return fixed


def _active_directions(level: Level, x: Array) -> Array:
    """Return the outward normals of inequalities that are at their bound within the tolerance, (k, n)."""
    values, tolerance, candidates = level.matrix @ x, _tolerance(level, x), ~_is_fixed(level, x)
    at_upper = candidates & (values >= level.upper - tolerance)
    at_lower = candidates & (values <= level.lower + tolerance)
    return np.vstack([level.matrix[at_upper], -level.matrix[at_lower]])


def _unit_rows(rows: Array) -> Array:
    norms = np.linalg.norm(rows, axis=1, keepdims=True)
    units: Array = rows / np.where(norms > 0.0, norms, 1.0)
    return units


def _unbalanced(gradient: Array, fixed_rows: Array, active_rows: Array) -> float:
    """Return min || gradient + fixed_rows^T y + active_rows^T nu || over y and nu >= 0."""
    if np.linalg.norm(gradient) < _NEGLIGIBLE_GRADIENT:
        return float(np.linalg.norm(gradient))
    if len(fixed_rows):
        _, sizes, directions = np.linalg.svd(_unit_rows(fixed_rows), full_matrices=False)
        span = directions[sizes > _RANK_TOLERANCE * max(float(sizes[0]), 1e-300)]
    else:
        span = np.zeros((0, len(gradient)))
    rest = gradient - span.T @ (span @ gradient)
    if not len(active_rows):
        return float(np.linalg.norm(rest))
    units = _unit_rows(active_rows)
    units = units - (units @ span.T) @ span
    try:
        return float(scipy.optimize.nnls(units.T, -rest, maxiter=2000)[1])
    except RuntimeError:  # did not converge
        return float("inf")
