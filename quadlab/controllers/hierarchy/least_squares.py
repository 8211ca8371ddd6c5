"""Least squares of minimum norm by a rank-revealing orthogonal factorisation."""

import math

from quadlab.controllers.hierarchy.factorisation import RANK_TOLERANCE, make_reflector, reflect, reflect_rows
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled, inlined


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
