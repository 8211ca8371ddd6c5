"""Cholesky factors of small matrices, compiled: calls of a library take longer than the arithmetic on a dozen rows."""

import math

from quadlab.geometry.rotations import Array
from quadlab.jit import compiled


@compiled
def factorise(matrix: Array) -> None:
    """Replace the lower triangle of a positive definite ``matrix`` (n, n) by its Cholesky factor; NaN if it is not."""
    for j in range(len(matrix)):
        for k in range(j):
            matrix[j, j] -= matrix[j, k] * matrix[j, k]
        matrix[j, j] = math.sqrt(matrix[j, j])
        for i in range(j + 1, len(matrix)):
            for k in range(j):
                matrix[i, j] -= matrix[i, k] * matrix[j, k]
            matrix[i, j] /= matrix[j, j]


@compiled
def solve_factor(factor: Array, columns: Array) -> None:
    """Replace ``columns`` (n, m) by G^-1 columns, G the lower triangle of ``factor``."""
    for i in range(len(factor)):
        for k in range(i):
            weight = factor[i, k]
            if weight != 0.0:  # mass matrices have many zeros: the legs of a robot do not couple
                for c in range(columns.shape[1]):
                    columns[i, c] -= weight * columns[k, c]
        for c in range(columns.shape[1]):
            columns[i, c] /= factor[i, i]


@compiled
def solve_transposed_factor(factor: Array, columns: Array) -> None:
    """Replace ``columns`` (n, m) by G^-T columns, G the lower triangle of ``factor``."""
    for i in range(len(factor) - 1, -1, -1):
        for c in range(columns.shape[1]):
            columns[i, c] /= factor[i, i]
        for k in range(i):
            weight = factor[i, k]
            if weight != 0.0:
                for c in range(columns.shape[1]):
                    columns[k, c] -= weight * columns[i, c]
