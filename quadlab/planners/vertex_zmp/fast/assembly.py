"""From named terms to one program: known quantities are put in, rows are stacked."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.program import BilinearProgram
from quadlab.planners.vertex_zmp.fast.rows import Equalities, Inequalities, Products, Rows
from quadlab.planners.vertex_zmp.footholds import IntArray

_NEGLIGIBLE = 1e-14  # entries of rows below this are rounding


@dataclass(frozen=True)
class Unknowns:
    """Which entries of the vector are unknown, and the values of the others.

    Attributes:
        index: place of each entry among the unknowns, -1 for known ones, (s,).
        known: value of each known entry, 0 for the others, (s,).
    """

    index: IntArray
    known: Array

    @property
    def count(self) -> int:
        """Number of unknowns."""
        return int((self.index >= 0).sum())

    def split(self, rows: Rows) -> tuple[sparse.csr_array, Array]:
        """Return rows over the unknowns, and their constants with all that is known."""
        count = len(rows.constants)
        place = self.index[rows.columns]
        use = (np.abs(rows.values) > _NEGLIGIBLE) & (place >= 0)
        row = np.broadcast_to(np.arange(count)[:, None], rows.columns.shape)[use]
        matrix = sparse.csr_array((rows.values[use], (row, place[use])), shape=(count, self.count))
        return matrix, rows.constants + np.sum(rows.values * self.known[rows.columns], axis=1)


def assemble(
    unknowns: Unknowns,
    equalities: Sequence[Equalities],
    inequalities: Sequence[Inequalities],
    costs: Sequence[tuple[float, Rows]],
) -> BilinearProgram:
    """Return the program of named terms; costs with weight 0 are left out, and inequalities without unknowns too."""
    linear, right, products = _equalities(unknowns, equalities)
    weighted = {rows.name: _weighted(unknowns, weight, rows) for weight, rows in costs if weight > 0.0}
    hessian = sparse.csc_array((unknowns.count, unknowns.count))
    gradient, constant = np.zeros(unknowns.count), 0.0
    if weighted:
        stacked = sparse.vstack([rows for rows, _ in weighted.values()], format="csr")
        rest = np.concatenate([rest for _, rest in weighted.values()])
        hessian = (2.0 * (stacked.T @ stacked)).tocsc()
        gradient, constant = 2.0 * (stacked.T @ rest), float(rest @ rest)
    split = [unknowns.split(term.rows) for term in inequalities]
    kept = [np.diff(matrix.indptr) > 0 for matrix, _ in split]
    names = [term.rows.name for term in inequalities]
    return BilinearProgram(
        hessian=hessian,
        gradient=gradient,
        constant=constant,
        linear=linear,
        right=right,
        products=products,
        inequality=sparse.vstack([m[keep] for (m, _), keep in zip(split, kept, strict=True)], format="csr"),
        lower=np.concatenate([(t.lower - c)[k] for t, (_, c), k in zip(inequalities, split, kept, strict=True)]),
        upper=np.concatenate([(t.upper - c)[k] for t, (_, c), k in zip(inequalities, split, kept, strict=True)]),
        equality_sets=_sets([term.rows.name for term in equalities], [len(t.rows.constants) for t in equalities]),
        inequality_sets=_sets(names, [int(keep.sum()) for keep in kept]),
        cost_rows=weighted,
    )


def _equalities(unknowns: Unknowns, terms: Sequence[Equalities]) -> tuple[sparse.csc_array, Array, Products]:
    """Return A (with room for the products), b and the products of two unknowns."""
    split = [unknowns.split(term.rows) for term in terms]
    begins = np.cumsum([0, *(len(constants) for _, constants in split)])
    linear = sparse.vstack([matrix for matrix, _ in split], format="coo")
    rows = np.concatenate([t.products.rows + b for t, b in zip(terms, begins[:-1], strict=True)])
    first, second = (
        np.concatenate([getattr(t.products, name) for t in terms]).astype(np.intp) for name in ("first", "second")
    )
    coefficients = np.concatenate([t.products.coefficients for t in terms])
    loads, stances = unknowns.index[first], unknowns.index[second]
    both = stances >= 0
    linear_values = np.where(both, 0.0, coefficients * unknowns.known[second])
    places_r = np.concatenate([linear.row, rows, rows[both]])
    places_c = np.concatenate([linear.col, loads, stances[both]])
    values = np.concatenate([linear.data, linear_values, np.zeros(int(both.sum()))])
    matrix = sparse.csc_array((values, (places_r, places_c)), shape=linear.shape)
    matrix.sort_indices()
    kept = Products(rows[both], loads[both], stances[both], coefficients[both])
    return matrix, -np.concatenate([constants for _, constants in split]), kept


def _weighted(unknowns: Unknowns, weight: float, rows: Rows) -> tuple[sparse.csr_array, Array]:
    matrix, constants = unknowns.split(rows)
    return matrix * np.sqrt(weight), constants * np.sqrt(weight)


def _sets(names: Sequence[str], counts: Sequence[int]) -> dict[str, slice]:
    ends = np.cumsum(counts)
    return {name: slice(int(end - count), int(end)) for name, count, end in zip(names, counts, ends, strict=True)}
