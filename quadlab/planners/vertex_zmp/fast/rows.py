"""Affine and bilinear rows over the vector of the program, before known quantities are put in."""

from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.footholds import IntArray


@dataclass(frozen=True)
class Rows:
    """m rows sum_j values_j v[columns_j] + constants, as one named set.

    Attributes:
        name: with the unit of the rows at the end.
        columns, values: up to k entries a row, (m, k); entries with the value 0 do not count.
        constants: (m,).
    """

    name: str
    columns: IntArray
    values: Array
    constants: Array


@dataclass(frozen=True)
class Products:
    """Products coefficients * v[first] * v[second] that belong to rows of an equality set.

    Attributes:
        rows, first, second: row and both factors of each product, (b,).
        coefficients: (b,).
    """

    rows: IntArray
    first: IntArray
    second: IntArray
    coefficients: Array


@dataclass(frozen=True)
class Equalities:
    """rows + products = 0.

    Attributes:
        rows: linear part.
        products: bilinear part; rows count from the first row of this set.
    """

    rows: Rows
    products: Products


@dataclass(frozen=True)
class Inequalities:
    """lower <= rows <= upper; infinite bounds are absent.

    Attributes:
        rows: linear.
        lower, upper: (m,).
    """

    rows: Rows
    lower: Array
    upper: Array


_NOTHING = np.zeros(0, dtype=np.intp)
NO_PRODUCTS = Products(_NOTHING, _NOTHING, _NOTHING, np.zeros(0))


def on_both_axes(columns: IntArray, values: Array) -> tuple[IntArray, Array]:
    """Return rows for x and for y, (2 m, k), from columns (m, k, 2 axes) and values (m, k); x and y alternate."""
    count, width, _ = columns.shape
    doubled = np.moveaxis(columns, 2, 1).reshape(2 * count, width)
    return doubled, np.repeat(values, 2, axis=0)
