"""The program as plain arrays, in the form in which the compiled solver walks through it."""

from typing import NamedTuple

import numpy as np
from scipy import sparse

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
    has_lower: Array
    has_upper: Array


def program_arrays(program: BilinearProgram) -> ProgramArrays:
    """Return the arrays of ``program``."""
    h, a, g = program.hessian, program.linear, program.inequality
    products = program.products
    return ProgramArrays(
        *_integers(h.indptr, h.indices),
        h.data.astype(float),
        program.gradient,
        *_integers(a.indptr, a.indices),
        a.data,
        program.right,
        *_integers(products.rows, products.first, products.second),
        products.coefficients,
        entry_places(a, products.rows, products.first),
        entry_places(a, products.rows, products.second),
        *_integers(g.indptr, g.indices),
        g.data,
        program.lower,
        program.upper,
        program.lower > -ABSENT,
        program.upper < ABSENT,
    )


def entry_places(matrix: sparse.csc_array, rows: IntArray, columns: IntArray) -> IntArray:
    """Return where the entries (rows, columns) sit among the stored values of a matrix with sorted columns."""
    height = matrix.shape[0]
    stored = np.repeat(np.arange(matrix.shape[1]), np.diff(matrix.indptr)) * height + matrix.indices
    return np.searchsorted(stored, columns * height + rows).astype(np.intp)


def _integers(*arrays: np.ndarray) -> tuple[IntArray, ...]:
    return tuple(np.ascontiguousarray(array, dtype=np.intp) for array in arrays)
