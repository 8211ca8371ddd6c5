"""Planning of the factorisation K = L D L' from the pattern of K alone."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from quadlab.jit import source_fingerprint
from quadlab.planners.vertex_zmp.fast.solver.jit import compiled, compiled_entry
from quadlab.planners.vertex_zmp.footholds import IntArray


class Elimination(NamedTuple):
    """Pattern of L for a permuted symmetric matrix whose upper triangle is stored by columns.

    Attributes:
        order: order[k] is the row of the original matrix that is eliminated k-th.
        k_begins, k_rows: upper triangle of the permuted matrix; the diagonal comes last in each column.
        row_begins, row_columns: columns of L with an entry in each row, in an order in which they can be eliminated.
        l_begins, l_rows: L by columns, without its unit diagonal.
    """

    order: IntArray
    k_begins: IntArray
    k_rows: IntArray
    row_begins: IntArray
    row_columns: IntArray
    l_begins: IntArray
    l_rows: IntArray


def fill_reducing_order(pattern: sparse.csc_array) -> IntArray:
    """Return an order of elimination with little fill for a symmetric pattern with a full diagonal.

    Minimum degree on the pattern of K + K', as SuperLU does it; the values given to it make K diagonally dominant.
    """
    dominant = pattern.copy()
    dominant.data = np.ones(len(dominant.data))
    dominant = (dominant + (pattern.shape[0] + 1.0) * sparse.eye_array(pattern.shape[0])).tocsc()
    factors = splu(dominant, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return np.argsort(factors.perm_c).astype(np.intp)


@compiled
def _plan_elimination(order: IntArray, k_begins: IntArray, k_rows: IntArray) -> Elimination:
    size = len(k_begins) - 1
    parent, counts = _tree(k_begins, k_rows)
    row_begins = np.zeros(size + 1, np.intp)
    l_begins = np.zeros(size + 1, np.intp)
    for k in range(size):
        l_begins[k + 1] = l_begins[k] + counts[k]
    row_columns = np.empty(l_begins[size], np.intp)
    l_rows = np.empty(l_begins[size], np.intp)
    filled = np.zeros(size, np.intp)
    mark = np.full(size, -1, np.intp)
    path = np.empty(size, np.intp)
    stack = np.empty(size, np.intp)
    for k in range(size):
        top = _row_pattern(k, k_begins, k_rows, parent, mark, path, stack)
        row_begins[k + 1] = row_begins[k] + size - top
        for position in range(top, size):
            column = stack[position]
            row_columns[row_begins[k] + position - top] = column
            l_rows[l_begins[column] + filled[column]] = k
            filled[column] += 1
    return Elimination(order, k_begins, k_rows, row_begins, row_columns, l_begins, l_rows)


@compiled
def _tree(k_begins: IntArray, k_rows: IntArray) -> tuple[IntArray, IntArray]:
    """Return the elimination tree (parent of each column, -1 for roots) and the entries of L in each column."""
    size = len(k_begins) - 1
    parent = np.full(size, -1, np.intp)
    counts = np.zeros(size, np.intp)
    mark = np.full(size, -1, np.intp)
    for k in range(size):
        mark[k] = k
        for entry in range(k_begins[k], k_begins[k + 1]):
            row = k_rows[entry]
            while row < k and mark[row] != k:
                if parent[row] == -1:
                    parent[row] = k
                counts[row] += 1
                mark[row] = k
                row = parent[row]
    return parent, counts


@compiled
def _row_pattern(
    k: int, k_begins: IntArray, k_rows: IntArray, parent: IntArray, mark: IntArray, path: IntArray, stack: IntArray
) -> int:
    """Write the columns of row ``k`` of L in topological order to the end of ``stack``; return where they begin."""
    top = len(stack)
    mark[k] = k
    for entry in range(k_begins[k], k_begins[k + 1]):
        row = k_rows[entry]
        length = 0
        while row < k and mark[row] != k:
            path[length] = row
            length += 1
            mark[row] = k
            row = parent[row]
        while length > 0:
            length -= 1
            top -= 1
            stack[top] = path[length]
    return top


def _compile_entry(fingerprint: int) -> Callable[[IntArray, IntArray, IntArray], Elimination]:
    """Return the entry point, which is compiled anew when any file of this folder has changed."""

    def entry(order: IntArray, k_begins: IntArray, k_rows: IntArray) -> Elimination:
        _ = fingerprint
        return _plan_elimination(order, k_begins, k_rows)

    return compiled_entry(entry)


_entry = _compile_entry(source_fingerprint(Path(__file__).parent))


def plan_elimination(order: IntArray, k_begins: IntArray, k_rows: IntArray) -> Elimination:
    """Return the pattern of L for the permuted upper triangle (k_begins, k_rows).

    Args:
        order: the row of the original matrix that is eliminated k-th, (n,).
        k_begins, k_rows: upper triangle by columns with sorted rows, (n + 1,) and (entries,).
    """
    return _entry(order, k_begins, k_rows)
