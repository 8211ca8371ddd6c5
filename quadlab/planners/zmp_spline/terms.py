"""What a formulation is made of: named bounds and named costs, both over all knot states."""

from dataclasses import dataclass

from scipy.sparse import csr_array

from quadlab.geometry.rotations import Array


@dataclass(frozen=True)
class Bound:
    """rows x <= upper, as one named set.

    Attributes:
        name: with the unit of the rows at the end.
        rows: (m, states).
        upper: (m,).
        times_s: time that each row belongs to, (m,) in [s].
        slack_weights: price of a squared violation of each row, (m,); None for a hard constraint.
    """

    name: str
    rows: csr_array
    upper: Array
    times_s: Array
    slack_weights: Array | None = None


@dataclass(frozen=True)
class SquaredCost:
    """sum weights (rows x - targets)^2.

    Attributes:
        name: of the term.
        rows: (m, states).
        targets, weights: (m,).
    """

    name: str
    rows: csr_array
    targets: Array
    weights: Array

    def value(self, states: Array) -> float:
        """Return the cost of a vector of all knot states."""
        return float(self.weights @ (self.rows @ states - self.targets) ** 2)
