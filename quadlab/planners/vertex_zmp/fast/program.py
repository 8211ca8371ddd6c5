"""A program that is quadratic but for products of two unknowns in its equalities, with named sets."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.rows import Products
from quadlab.planners.vertex_zmp.solution import worst_violation


@dataclass(frozen=True)
class BilinearProgram:
    """min z' H z / 2 + h' z + f  subject to  A z + products(z) = b,  lower <= G z <= upper.

    Attributes:
        hessian, gradient, constant: H sparse (n, n), h (n,), f.
        linear, right: A sparse by columns (e, n) and b (e,); A stores zeros where only products act.
        products: bilinear part of the equalities.
        inequality, lower, upper: G sparse by rows (i, n) and its bounds (i,).
        equality_sets, inequality_sets: rows of each named set.
        cost_rows: for each cost by name, sparse rows R and constants r with cost = ||R z + r||^2.
    """

    hessian: sparse.csc_array
    gradient: Array
    constant: float
    linear: sparse.csc_array
    right: Array
    products: Products
    inequality: sparse.csr_array
    lower: Array
    upper: Array
    equality_sets: Mapping[str, slice]
    inequality_sets: Mapping[str, slice]
    cost_rows: Mapping[str, tuple[sparse.csr_array, Array]]

    @property
    def size(self) -> int:
        """Number of unknowns n."""
        return len(self.gradient)

    def equality_values(self, z: Array) -> Array:
        """Return A z + products(z) - b, (e,)."""
        terms = self.products.coefficients * z[self.products.first] * z[self.products.second]
        total: Array = self.linear @ z + np.bincount(self.products.rows, terms, len(self.right)) - self.right
        return total

    def jacobian(self, z: Array) -> sparse.csc_array:
        """Return the derivative of ``equality_values``, sparse (e, n)."""
        rows, first, second = self.products.rows, self.products.first, self.products.second
        values = np.concatenate([self.products.coefficients * z[second], self.products.coefficients * z[first]])
        places = np.concatenate([rows, rows]), np.concatenate([first, second])
        total: sparse.csc_array = self.linear + sparse.csc_array((values, places), shape=self.linear.shape)
        return total

    def objective(self, z: Array) -> float:
        """Return z' H z / 2 + h' z + f."""
        return float(0.5 * z @ (self.hessian @ z) + self.gradient @ z) + self.constant

    def costs(self, z: Array) -> dict[str, float]:
        """Return each weighted cost."""
        return {name: float(np.sum((rows @ z + rest) ** 2)) for name, (rows, rest) in self.cost_rows.items()}

    def residuals(self, z: Array) -> dict[str, float]:
        """Return the worst violation of each constraint set, in the unit that its name carries."""
        equality, inequality = self.equality_values(z), self.inequality @ z
        outside = np.maximum(self.lower - inequality, inequality - self.upper)
        found = {name: worst_violation(np.abs(equality[rows])) for name, rows in self.equality_sets.items()}
        return found | {name: worst_violation(outside[rows]) for name, rows in self.inequality_sets.items()}
