"""The program as plain arrays, in the form in which the compiled solver walks through it."""

from typing import NamedTuple

import numpy as np
from scipy import sparse

from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.program import BilinearProgram
from quadlab.planners.vertex_zmp.footholds import IntArray

ABSENT = 1e20  # bounds of this size and more do not exist


class ProgramArrays(NamedTuple):
    """A bilinear program; sparse matrices as (begins, indices, values).

    Attributes:
        h_begins, h_rows, h_values: H by columns.
        gradient: h.
        a_begins, a_rows, a_values: A by columns.
        right: b.
        p_rows, p_first, p_second, p_coefficients: products.
        p_by_first, p_by_second: place among the entries of A of d product / d first and d second.
        g_begins, g_columns, g_values: G by rows.
        lower, upper: bounds of G z.
        has_lower, has_upper: which of them exist.
    """

    h_begins: IntArray
    h_rows: IntArray
    h_values: Array
    gradient: Array
    a_begins: IntArray
    a_rows: IntArray
    a_values: Array
    right: Array
    p_rows: IntArray
    p_first: IntArray
    p_second: IntArray
    p_coefficients: Array
    p_by_first: IntArray
    p_by_second: IntArray
    g_begins: IntArray
    g_columns: IntArray
    g_values: Array
    lower: Array
    upper: Array
    has_lower: BoolArray
    has_upper: BoolArray


def program_arrays(program: BilinearProgram) -> ProgramArrays:
    """Return the arrays of ``program``."""
    h, a, g, products = program.hessian, program.linear, program.inequality, program.products
    return ProgramArrays(
        h_begins=_integers(h.indptr),
        h_rows=_integers(h.indices),
        h_values=h.data.astype(float),
        gradient=program.gradient,
        a_begins=_integers(a.indptr),
        a_rows=_integers(a.indices),
        a_values=a.data,
        right=program.right,
        p_rows=_integers(products.rows),
        p_first=_integers(products.first),
        p_second=_integers(products.second),
        p_coefficients=products.coefficients,
        p_by_first=entry_places(a, products.rows, products.first),
        p_by_second=entry_places(a, products.rows, products.second),
        g_begins=_integers(g.indptr),
        g_columns=_integers(g.indices),
        g_values=g.data,
        lower=program.lower,
        upper=program.upper,
        has_lower=program.lower > -ABSENT,
        has_upper=program.upper < ABSENT,
    )


def entry_places(matrix: sparse.csc_array, rows: IntArray, columns: IntArray) -> IntArray:
    """Return where the entries (rows, columns) sit among the stored values of a matrix with sorted columns."""
    height = matrix.shape[0]
    stored = np.repeat(np.arange(matrix.shape[1]), np.diff(matrix.indptr)) * height + matrix.indices
    return np.searchsorted(stored, columns * height + rows).astype(np.intp)


def _integers(array: np.ndarray) -> IntArray:
    return np.ascontiguousarray(array, dtype=np.intp)
