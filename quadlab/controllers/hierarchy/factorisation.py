"""Householder reflections, and the orthogonal factorisation of a working set.

All factorisations of the solver are built from reflections H = I - scale v v^T, and all of them call a row dependent on
earlier ones if what is left of it is small compared with the row as it was given: its scale does not matter.
"""

import math

from quadlab.controllers.hierarchy.level import IndexArray
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled, inlined

RANK_TOLERANCE = 1e-8  # of least squares and eliminations
# Smaller than the slope at which a row can block a step, so that a row that has just joined is never dropped again.
WORKING_SET_TOLERANCE = 1e-10


@inlined
def tail_norm(vector: Array, begin: int, end: int) -> float:
    """Return the Euclidean norm of ``vector[begin:end]``."""
    square = 0.0
    for index in range(begin, end):
        square += vector[index] * vector[index]
    return math.sqrt(square)


@inlined
def make_reflector(vector: Array, begin: int, norm: float) -> tuple[float, float]:
    """Overwrite ``vector[begin:]`` with v so that H maps it on pivot * e_begin; return (pivot, scale).

    Args:
        vector: the vector a.
        begin: first index that takes part.
        norm: ||a[begin:]||, positive. The sign of the pivot avoids cancellation in v = a - pivot e.
    """
    pivot = -norm if vector[begin] > 0.0 else norm
    vector[begin] -= pivot
    return pivot, -1.0 / (pivot * vector[begin])


@inlined
def reflect(vector: Array, reflector: Array, scale: float, begin: int, end: int) -> None:
    """Apply H to ``vector[begin:end]`` in place."""
    product = 0.0
    for index in range(begin, end):
        product += vector[index] * reflector[index]
    product *= scale
    for index in range(begin, end):
        vector[index] -= product * reflector[index]


@inlined
def reflect_rows(matrix: Array, first: int, last: int, reflector: Array, scale: float, begin: int, end: int) -> None:
    """Apply H to ``matrix[row, begin:end]`` of the rows ``first`` to ``last`` in place."""
    for row in range(first, last):
        product = 0.0
        for column in range(begin, end):
            product += matrix[row, column] * reflector[column]
        product *= scale
        for column in range(begin, end):
            matrix[row, column] -= product * reflector[column]


@compiled
def factorise_rows(
    rows: Array,
    norms: Array,
    selected: IndexArray,
    count: int,
    fixed: int,
    basis: Array,
    triangle: Array,
    vector: Array,
) -> int:
    """Find an orthonormal basis [Y Z] of the free coordinates with  G_W = T Y^T,  G_W Z = 0,  T lower triangular.

    G_W are the selected rows in the free coordinates; Y spans their range, Z their null space. Independent rows move
    to the front of ``selected``, dependent ones behind them.

    Args:
        rows: (rows, n) all rows in rotated coordinates.
        norms: norm of each row.
        selected: row indices, the first ``count`` are used.
        count: number of selected rows.
        fixed: number of coordinates that are not free.
        basis: (n, n) output, [Y Z] in its first n - fixed rows and columns.
        triangle: (n, n) output, T.
        vector: (n,) scratch.

    Returns:
        Number of independent rows, the columns of Y.
    """
    free = rows.shape[1] - fixed
    for i in range(free):
        for j in range(free):
            basis[i, j] = 0.0
        basis[i, i] = 1.0
    rank = 0
    for position in range(count):
        row = selected[position]
        for j in range(free):
            vector[j] = 0.0
        for i in range(free):
            entry = rows[row, fixed + i]
            for j in range(free):
                vector[j] += entry * basis[i, j]
        rest = tail_norm(vector, rank, free)
        if rest <= WORKING_SET_TOLERANCE * norms[row]:
            continue
        pivot, scale = make_reflector(vector, rank, rest)
        reflect_rows(basis, 0, free, vector, scale, rank, free)
        for j in range(rank):
            triangle[rank, j] = vector[j]
        triangle[rank, rank] = pivot
        selected[position] = selected[rank]
        selected[rank] = row
        rank += 1
    return rank


@inlined
def solve_transposed(triangle: Array, rank: int, right: Array) -> None:
    """Overwrite ``right`` with the solution of T^T y = right (back substitution)."""
    for i in range(rank - 1, -1, -1):
        total = right[i]
        for j in range(i + 1, rank):
            total -= triangle[j, i] * right[j]
        right[i] = total / triangle[i, i]
