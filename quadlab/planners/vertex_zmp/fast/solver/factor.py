"""Numeric factorisation K = L D L' with a pattern that is known, and solution with it."""

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.solver.elimination import Elimination
from quadlab.planners.vertex_zmp.fast.solver.jit import compiled
from quadlab.planners.vertex_zmp.footholds import IntArray


@compiled
def factorise(
    plan: Elimination, k_values: Array, l_values: Array, inverse_pivots: Array, row: Array, filled: IntArray
) -> int:
    """Fill ``l_values`` and ``inverse_pivots``, row after row; return the number of negative pivots.

    Args:
        plan: pattern.
        k_values: upper triangle of the permuted matrix.
        l_values, inverse_pivots: result.
        row: work space of zeros (n,), zero again afterwards.
        filled: work space (n,).
    """
    negative = 0
    k_begins, k_rows, l_begins, l_rows = plan.k_begins, plan.k_rows, plan.l_begins, plan.l_rows
    filled[:] = l_begins[:-1]
    for k in range(len(inverse_pivots)):
        for entry in range(k_begins[k], k_begins[k + 1] - 1):
            row[k_rows[entry]] = k_values[entry]
        pivot = k_values[k_begins[k + 1] - 1]
        for position in range(plan.row_begins[k], plan.row_begins[k + 1]):
            column = plan.row_columns[position]
            value = row[column]
            row[column] = 0.0
            end = filled[column]
            for entry in range(l_begins[column], end):
                row[l_rows[entry]] -= l_values[entry] * value
            scaled = value * inverse_pivots[column]
            pivot -= scaled * value
            l_values[end] = scaled
            filled[column] = end + 1
        if pivot < 0.0:
            negative += 1
        inverse_pivots[k] = 1.0 / pivot
    return negative


@compiled
def solve_in_place(plan: Elimination, l_values: Array, inverse_pivots: Array, permuted: Array) -> None:
    """Replace ``permuted``, the right-hand side in the order of elimination, by the solution."""
    l_begins, l_rows = plan.l_begins, plan.l_rows
    size = len(permuted)
    for k in range(size):
        value = permuted[k]
        for entry in range(l_begins[k], l_begins[k + 1]):
            permuted[l_rows[entry]] -= l_values[entry] * value
    for k in range(size - 1, -1, -1):
        value = permuted[k] * inverse_pivots[k]
        for entry in range(l_begins[k], l_begins[k + 1]):
            value -= l_values[entry] * permuted[l_rows[entry]]
        permuted[k] = value
