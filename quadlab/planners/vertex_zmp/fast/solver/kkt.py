"""The linear system of an interior-point step, its pattern and where every number goes."""

from collections import OrderedDict
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.program import BilinearProgram
from quadlab.planners.vertex_zmp.fast.solver.elimination import Elimination, fill_reducing_order, plan_elimination
from quadlab.planners.vertex_zmp.footholds import IntArray

_REMEMBERED = 16  # patterns


class KktPlan(NamedTuple):
    """K = [H + G' D G + curvature + regularisation, J'; J, -regularisation] in the order of elimination.

    All places are positions among the values of the permuted upper triangle.

    Attributes:
        elimination: pattern of K and of its factor.
        diagonal: place of each diagonal entry; unknowns first, then equalities, (n + e,).
        from_a: place of each entry of A, (nnz A,).
        from_h: place of each entry of H, -1 for its lower triangle, (nnz H,).
        from_products: place of the curvature of each product, (b,).
        pair_begins: pairs of entries of each row of G, (i + 1,).
        pair_places: place of each pair, (q,).
    """

    elimination: Elimination
    diagonal: IntArray
    from_a: IntArray
    from_h: IntArray
    from_products: IntArray
    pair_begins: IntArray
    pair_places: IntArray


_plans: "OrderedDict[bytes, KktPlan]" = OrderedDict()


def kkt_plan(program: BilinearProgram) -> KktPlan:
    """Return the plan for the pattern of ``program``; plans of recent patterns are remembered."""
    matrices = program.hessian, program.linear, program.inequality
    arrays = [array for matrix in matrices for array in (matrix.indptr, matrix.indices)]
    key = b"|".join(np.asarray(array, np.int32).tobytes() for array in arrays)
    if key not in _plans:
        _plans[key] = _new_plan(program)
        while len(_plans) > _REMEMBERED:
            _plans.popitem(last=False)
    _plans.move_to_end(key)
    return _plans[key]


def forget_plans() -> None:
    """Forget all remembered plans, so that the next build plans anew."""
    _plans.clear()


def row_pairs(matrix: sparse.csr_array) -> tuple[IntArray, IntArray, IntArray]:
    """Return all pairs (a <= b) of entries of the same row: begins (i + 1,), first and second entry (q,)."""
    counts = np.diff(matrix.indptr).astype(np.intp)
    begins = np.concatenate([[0], np.cumsum(counts * (counts + 1) // 2)]).astype(np.intp)
    first, second = np.empty(begins[-1], np.intp), np.empty(begins[-1], np.intp)
    for width in np.unique(counts):
        rows = np.flatnonzero(counts == width)
        a, b = np.triu_indices(width)
        places = begins[rows][:, None] + np.arange(len(a))
        first[places] = matrix.indptr[rows][:, None] + a
        second[places] = matrix.indptr[rows][:, None] + b
    return begins, first, second


def pair_products(matrix: sparse.csr_array) -> Array:
    """Return the product of the values of each pair of :func:`row_pairs`, (q,)."""
    _, first, second = row_pairs(matrix)
    values: Array = matrix.data[first] * matrix.data[second]
    return values


def _new_plan(program: BilinearProgram) -> KktPlan:
    n, e = program.size, len(program.right)
    h, a, g, products = program.hessian, program.linear, program.inequality, program.products
    h_columns = np.repeat(np.arange(n), np.diff(h.indptr))
    a_columns = np.repeat(np.arange(n), np.diff(a.indptr))
    begins, first, second = row_pairs(g)
    upper = h.indices <= h_columns
    blocks: list[tuple[NDArray[np.integer], NDArray[np.integer]]] = [
        (np.arange(n + e), np.arange(n + e)),
        (a_columns, n + a.indices),
        (h.indices[upper], h_columns[upper]),
        (products.first, products.second),
        (g.indices[first], g.indices[second]),
    ]
    rows = np.concatenate([block[0] for block in blocks]).astype(np.intp)
    columns = np.concatenate([block[1] for block in blocks]).astype(np.intp)
    unique, back = _unique_pairs(rows, columns, n + e)
    rows, columns = unique // (n + e), unique % (n + e)
    pattern = sparse.csc_array((np.ones(len(rows)), (rows, columns)), shape=(n + e, n + e))
    order = fill_reducing_order((pattern + pattern.T).tocsc())
    elimination, places = _permuted(order, rows, columns)
    ends = np.cumsum([len(block[0]) for block in blocks])
    diagonal, from_a, from_upper, from_products, pairs = np.split(places[back], ends[:-1])
    from_h = np.full(len(h.indices), -1, np.intp)
    from_h[upper] = from_upper
    return KktPlan(elimination, diagonal, from_a, from_h, from_products, begins, pairs)


def _unique_pairs(rows: IntArray, columns: IntArray, size: int) -> tuple[IntArray, IntArray]:
    """Return sorted codes row * size + column of the distinct places of a symmetric matrix, and how to go back."""
    codes = np.minimum(rows, columns) * size + np.maximum(rows, columns)
    unique, back = np.unique(codes, return_inverse=True)
    return unique, back


def _permuted(order: IntArray, rows: IntArray, columns: IntArray) -> tuple[Elimination, IntArray]:
    """Return the elimination in the given order and the place of each of the distinct entries (rows, columns)."""
    size = len(order)
    rank = np.empty(size, np.intp)
    rank[order] = np.arange(size)
    first, second = rank[rows], rank[columns]
    codes = np.maximum(first, second) * size + np.minimum(first, second)
    sorting = np.argsort(codes)
    places = np.empty(len(codes), np.intp)
    places[sorting] = np.arange(len(codes))
    codes = codes[sorting]
    begins = np.searchsorted(codes // size, np.arange(size + 1)).astype(np.intp)
    return plan_elimination(order, begins, (codes % size).astype(np.intp)), places
