"""The memory of one solve: rows in rotated coordinates, the role of each row, and the working set.

The solver never moves in x itself but in rotated coordinates u = Q^T x, where the orthogonal matrix Q is a product of
Householder reflections. It is built so that the first ``fixed`` coordinates are those that higher levels have used
up: moving in the other, free coordinates u[fixed:] changes none of the rows that were eliminated.
"""

import math
from typing import NamedTuple

import numpy as np

from quadlab.controllers.hierarchy.level import IndexArray
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled, inlined

# Roles of a row. A positive role means its upper bound, a negative one its lower bound.
FREE = 0  # satisfied, or of a level not yet reached
PULLED = 1  # a violated inequality of the level at hand: its violation is part of the objective
EQUALITY = 2  # an equality of the level at hand: always part of the objective
HELD = 3  # in the working set: kept exactly at its bound
ELIMINATED = 4  # decided for good; the free coordinates cannot change it

ABSOLUTE_TOLERANCE = 1e-9  # a row of norm 1 counts as satisfied within this ...
RELATIVE_TOLERANCE = 1e-12  # ... plus this times the largest coordinate


class Workspace(NamedTuple):
    """Arrays of one solve, for m rows in n unknowns; n spare rows hold the last, implicit level.

    Attributes:
        rows: (m + n, n) rows in rotated coordinates, matrix @ Q.
        lower, upper: (m + n,) bounds.
        norms: (m + n,) Euclidean norm of each row; every tolerance is relative to it.
        values: (m + n,) rows @ point, for the levels reached so far.
        rates: (m + n,) change of the values over the current step.
        roles: (m + n,) role of each row.
        point: (n,) current rotated coordinates u.
        anchor: (n,) the start in the same rotated coordinates.
        reflectors: (n, n) Householder vector of each elimination, from its own index on.
        reflector_scales: (n,) their factors.
        working: (n + 1,) rows of the working set.
        multipliers: (n + 1,) their Lagrange multipliers at the last stationary point.
        basis: (n, n) orthonormal basis [range | null space] of the working set in the free coordinates.
        triangle: (n, n) lower triangle T with (working rows) = T @ range.T.
        step: (n,) current step in the free coordinates.
        system: (m + n, n), system_norms: (m + n,), target: (m + n,), factor: (m + n, n), solution: (n,),
        vector: (n,): scratch of the least-squares problem.
        candidates: (m + n,) rows to eliminate.
    """

    rows: Array
    lower: Array
    upper: Array
    norms: Array
    values: Array
    rates: Array
    roles: IndexArray
    point: Array
    anchor: Array
    reflectors: Array
    reflector_scales: Array
    working: IndexArray
    multipliers: Array
    basis: Array
    triangle: Array
    step: Array
    system: Array
    system_norms: Array
    target: Array
    factor: Array
    solution: Array
    vector: Array
    candidates: IndexArray


@compiled
def allocate(matrix: Array, lower: Array, upper: Array, start: Array) -> Workspace:
    """Return the workspace at ``start``, with Q = I and no row decided."""
    count, dimension = matrix.shape
    capacity = count + dimension
    workspace = Workspace(
        np.empty((capacity, dimension)),
        np.empty(capacity),
        np.empty(capacity),
        np.empty(capacity),
        np.empty(capacity),
        np.empty(capacity),
        np.zeros(capacity, np.int64),
        start.copy(),
        start.copy(),
        np.empty((dimension, dimension)),
        np.empty(dimension),
        np.empty(dimension + 1, np.int64),
        np.empty(dimension + 1),
        np.empty((dimension, dimension)),
        np.empty((dimension, dimension)),
        np.empty(dimension),
        np.empty((capacity, dimension)),
        np.empty(capacity),
        np.empty(capacity),
        np.empty((capacity, dimension)),
        np.empty(dimension),
        np.empty(dimension),
        np.empty(capacity, np.int64),
    )
    rows, norms = workspace.rows, workspace.norms
    for row in range(count):
        square = 0.0
        for column in range(dimension):
            entry = matrix[row, column]
            rows[row, column] = entry
            square += entry * entry
        norms[row] = math.sqrt(square)
    workspace.lower[:count] = lower
    workspace.upper[:count] = upper
    return workspace


@inlined
def bound_of(role: int, lower: float, upper: float) -> float:
    """Return the bound that a role refers to."""
    return upper if role > 0 else lower


@inlined
def in_objective(role: int) -> bool:
    """Return whether the residual of a row with this role is part of the objective."""
    return role in (PULLED, -PULLED, EQUALITY)


@inlined
def row_tolerance(point: Array) -> float:
    """Return by how much a row of norm 1 may miss its bound at ``point`` and still count as satisfied."""
    largest = 0.0
    for coordinate in point:
        largest = max(largest, abs(coordinate))
    return ABSOLUTE_TOLERANCE + RELATIVE_TOLERANCE * largest
