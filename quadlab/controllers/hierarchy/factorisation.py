"""Orthogonal factorisations with rank decisions: bases of a working set and least squares of minimum norm.

All of them are built from Householder reflections H = I - scale v v^T, and all of them call a row dependent on earlier
ones if what is left of it is small compared with the row as it was given, so that the scale of a row does not matter.
"""

import math

from quadlab.controllers.hierarchy.jit import compiled, inlined
from quadlab.controllers.hierarchy.level import IndexArray
from quadlab.geometry.rotations import Array

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


@inlined
def swap_rows(matrix: Array, first: int, second: int) -> None:
    """Exchange two rows of ``matrix``."""
    for column in range(matrix.shape[1]):
        entry = matrix[first, column]
        matrix[first, column] = matrix[second, column]
        matrix[second, column] = entry


@inlined
def most_independent(matrix: Array, norms: Array, begin: int, count: int, columns: int) -> tuple[int, float]:
    """Return (row, rest): the row from ``begin`` on that keeps the largest share of its norm in columns[begin:]."""
    best_row, best_share, best_rest = -1, RANK_TOLERANCE, 0.0
    for row in range(begin, count):
        square = 0.0
        for column in range(begin, columns):
            square += matrix[row, column] * matrix[row, column]
        rest = math.sqrt(square)
        if rest > best_share * norms[row]:
            best_row, best_share, best_rest = row, rest / norms[row], rest
    return best_row, best_rest


@inlined
def reduce_rows(
    system: Array, norms: Array, target: Array, count: int, columns: int, factor: Array, scales: Array
) -> int:
    """Reduce B = L Q^T by reflections from the right, with the most independent row as the next pivot.

    Args:
        system: (rows, columns) B; afterwards row i holds the vector of reflection i from column i on.
        norms: reference norm of each row of B, against which its rest is compared.
        target: right-hand side, permuted like the rows.
        count, columns: size of B.
        factor: output, L: (count, rank) lower trapezoidal.
        scales: output, factor of each reflection.

    Returns:
        The rank of B.
    """
    for rank in range(min(count, columns)):
        pivot_row, rest = most_independent(system, norms, rank, count, columns)
        if pivot_row < 0:
            return rank
        if pivot_row != rank:
            swap_rows(system, pivot_row, rank)
            swap_rows(factor, pivot_row, rank)
            norms[pivot_row], norms[rank] = norms[rank], norms[pivot_row]
            target[pivot_row], target[rank] = target[rank], target[pivot_row]
        reflector = system[rank]
        for row in range(rank):
            factor[row, rank] = 0.0
        factor[rank, rank], scales[rank] = make_reflector(reflector, rank, rest)
        reflect_rows(system, rank + 1, count, reflector, scales[rank], rank, columns)
        for row in range(rank + 1, count):
            factor[row, rank] = system[row, rank]
    return min(count, columns)


@inlined
def triangularise_columns(factor: Array, target: Array, count: int, rank: int) -> None:
    """Reduce L = P R by reflections from the left, so that min ||L y - target|| becomes R y = (P^T target)[:rank].

    Args:
        factor: (count, rank), full column rank; afterwards R in its upper triangle.
        target: (count,) right-hand side; afterwards P^T target.
        count, rank: size of L.
    """
    for column in range(rank):
        square = 0.0
        for row in range(column, count):
            square += factor[row, column] * factor[row, column]
        norm = math.sqrt(square)
        pivot = -norm if factor[column, column] > 0.0 else norm
        factor[column, column] -= pivot
        scale = -1.0 / (pivot * factor[column, column])
        for other in range(column + 1, rank):
            product = 0.0
            for row in range(column, count):
                product += factor[row, column] * factor[row, other]
            for row in range(column, count):
                factor[row, other] -= scale * product * factor[row, column]
        product = 0.0
        for row in range(column, count):
            product += factor[row, column] * target[row]
        for row in range(column, count):
            target[row] -= scale * product * factor[row, column]
        factor[column, column] = pivot


@compiled
def solve_least_squares(
    system: Array, norms: Array, target: Array, count: int, columns: int, factor: Array, scales: Array, solution: Array
) -> None:
    """Find the shortest minimiser of ||B z - target||; B, norms, target and factor are overwritten.

    B = L Q^T with L of full column rank r; y solves min ||L y - target||, and z = Q [y; 0].
    """
    rank = reduce_rows(system, norms, target, count, columns, factor, scales)
    for column in range(columns):
        solution[column] = 0.0
    if rank == count:  # L is a lower triangle: forward substitution
        for i in range(rank):
            total = target[i]
            for j in range(i):
                total -= factor[i, j] * solution[j]
            solution[i] = total / factor[i, i]
    else:
        triangularise_columns(factor, target, count, rank)
        for i in range(rank - 1, -1, -1):
            total = target[i]
            for j in range(i + 1, rank):
                total -= factor[i, j] * solution[j]
            solution[i] = total / factor[i, i]
    for i in range(rank - 1, -1, -1):
        reflect(solution, system[i], scales[i], i, columns)
