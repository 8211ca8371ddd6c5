"""Equalities by elimination: p = T y + p_0 satisfies all of them for any y."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, eye_array

from quadlab.errors import PlanningProblemError
from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.term import Equality
from quadlab.robots.pinocchio_model import IndexArray


@dataclass(frozen=True)
class Elimination:
    """The affine map from free variables y to all variables p.

    Attributes:
        matrix: T, (size of p, size of y).
        constant: p_0, (size of p,).
        free: indices in p of the free variables, (size of y,).
    """

    matrix: csr_array
    constant: Array
    free: IndexArray

    def expand(self, y: Array) -> Array:
        """Return p = T y + p_0."""
        p: Array = self.matrix @ y + self.constant
        return p

    def restrict(self, p: Array) -> Array:
        """Return the free variables of p."""
        return p[self.free]


def eliminate(equalities: Sequence[Equality], size: int) -> Elimination:
    """Return the map that satisfies p = S p + c for the substitutions S, c of all equalities.

    A variable may follow from others that follow from yet others; then T = (I + S + S^2 + ...) E, where E places the
    free variables, and p_0 = (I + S + S^2 + ...) c.

    Args:
        equalities: no variable is the target of two of them.
        size: length of p.

    Raises:
        PlanningProblemError: if two equalities determine one variable, or variables each other.
    """
    targets = np.concatenate([equality.targets for equality in equalities])
    if len(np.unique(targets)) < len(targets):
        names = ", ".join(equality.name for equality in equalities)
        raise PlanningProblemError(f"kinematic_sqp: a variable is determined twice among {names}")
    substitution = _substitution(equalities, size)
    constant = np.zeros(size)
    constant[targets] = np.concatenate([equality.constants for equality in equalities])
    closure = _closure(substitution)
    free = np.setdiff1d(np.arange(size, dtype=np.intp), targets)
    matrix = csr_array(closure[:, free])
    matrix.eliminate_zeros()
    return Elimination(matrix, closure @ constant, free)


def _substitution(equalities: Sequence[Equality], size: int) -> csr_array:
    """Return S, (size, size)."""
    rows = [np.repeat(equality.targets, equality.sources.shape[1]) for equality in equalities]
    columns = [equality.sources.ravel() for equality in equalities]
    factors = [equality.factors.ravel() for equality in equalities]
    entries = (np.concatenate(factors), (np.concatenate(rows), np.concatenate(columns)))
    return csr_array(entries, shape=(size, size))


def _closure(substitution: csr_array) -> csr_array:
    """Return I + S + S^2 + ... = (I + S) (I + S^2) (I + S^4) ... of a nilpotent S."""
    identity = csr_array(eye_array(substitution.shape[0], format="csr"))
    total, power = identity, substitution
    for _ in range(int(np.ceil(np.log2(substitution.shape[0]))) + 1):
        if power.nnz == 0:
            return total
        total = csr_array(total @ (identity + power))
        power = csr_array(power @ power)
        power.eliminate_zeros()
    raise PlanningProblemError("kinematic_sqp: equalities determine variables in a circle")
