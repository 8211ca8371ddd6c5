"""What the program is made of: named linear and nonlinear objectives, equalities and inequalities."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from scipy.sparse import csr_array

from quadlab.geometry.rotations import Array
from quadlab.robots.pinocchio_model import IndexArray


class Coordinates(NamedTuple):
    """Forward kinematics of all samples, in [m]: CoM (N, 3) and contact points (N, 4, 3)."""

    com: Array
    feet: Array


class Jacobians(NamedTuple):
    """Derivatives of ``Coordinates`` by q: (N, 3, 18) and, by base and own joints of the leg, (N, 4, 3, 9)."""

    com: Array
    feet: Array


@dataclass(frozen=True)
class LinearTerm:
    """The objective weight ||A p - b||^2.

    Attributes:
        name: of the objective.
        weight: alpha_j.
        matrix: A, (m, size of p).
        target: b, (m,).
    """

    name: str
    weight: float
    matrix: csr_array
    target: Array

    def residual(self, p: Array) -> Array:
        """Return A p - b, (m,)."""
        difference: Array = self.matrix @ p - self.target
        return difference


class BlockTerm(Protocol):
    """The objective weight sum_s ||r_s||^2 in which each r_s depends on few variables.

    Attributes:
        name: of the objective.
        weight: alpha_j.
        variables: indices in p on which each group s of residuals depends, (groups, v).
    """

    @property
    def name(self) -> str: ...  # noqa: D102

    @property
    def weight(self) -> float: ...  # noqa: D102

    @property
    def variables(self) -> IndexArray: ...  # noqa: D102

    def residual(self, p: Array, coordinates: Coordinates) -> Array:
        """Return the residuals r_s, (groups, m)."""
        ...

    def jacobian(self, p: Array, jacobians: Jacobians) -> Array:
        """Return their derivatives by ``variables``, (groups, m, v)."""
        ...


@dataclass(frozen=True)
class Equality:
    """Linear equalities p[targets] = S p + constant, solved for ``targets``.

    Attributes:
        name: of the constraint set.
        targets: variables that the set determines, (m,).
        sources: variables they follow from, (m, k).
        factors: of the sources, (m, k).
        constants: (m,).
    """

    name: str
    targets: IndexArray
    sources: IndexArray
    factors: Array
    constants: Array

    def violation(self, p: Array) -> float:
        """Return the largest residual."""
        right = (self.factors * p[self.sources]).sum(axis=1) + self.constants
        return float(np.abs(p[self.targets] - right).max(initial=0.0))


@dataclass(frozen=True)
class Inequality:
    """Linear inequalities lower <= A p <= upper.

    Attributes:
        name: of the constraint set.
        matrix: A, (m, size of p).
        lower, upper: (m,).
        often_active: whether they belong in every quadratic program; others join when a step violates them.
    """

    name: str
    matrix: csr_array
    lower: Array
    upper: Array
    often_active: bool = False

    def violation(self, p: Array) -> float:
        """Return the largest violation, 0 if there is none."""
        value = self.matrix @ p
        return float(np.maximum(self.lower - value, value - self.upper).max(initial=0.0))


def tie(name: str, targets: IndexArray, sources: IndexArray, offset: Array | float = 0.0) -> Equality:
    """Return p[targets] = p[sources] + offset, index arrays of one shape."""
    flat = targets.ravel()
    constants = np.broadcast_to(np.asarray(offset, float), targets.shape).ravel()
    return Equality(name, flat, sources.reshape(-1, 1), np.ones((len(flat), 1)), constants)


def fix(name: str, targets: IndexArray, values: Array | float) -> Equality:
    """Return p[targets] = values."""
    flat = targets.ravel()
    constants = np.broadcast_to(np.asarray(values, float), targets.shape).ravel()
    return Equality(name, flat, np.zeros((len(flat), 0), dtype=np.intp), np.zeros((len(flat), 0)), constants)


def rows(entries: Sequence[tuple[IndexArray, Array | float]], size: int) -> csr_array:
    """Return the matrix of sum_j factor_j p[indices_j], (m, size).

    Args:
        entries: pairs of indices, (m,), and factors that broadcast to (m,).
        size: length of p.
    """
    count = len(entries[0][0])
    numbers = np.tile(np.arange(count), len(entries))
    columns = np.concatenate([indices for indices, _ in entries])
    factors = np.concatenate([np.broadcast_to(np.asarray(factor, float), count) for _, factor in entries])
    return csr_array((factors, (numbers, columns)), shape=(count, size))
