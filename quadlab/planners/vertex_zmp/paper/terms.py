"""What a formulation is made of: named constraint sets and named costs."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from quadlab.geometry.rotations import Array


@dataclass(frozen=True)
class Constraint:
    """lower <= expression <= upper, as one named set.

    Attributes:
        name: with the unit of its residual at the end.
        expression: CasADi column vector, (m, 1).
        lower, upper: bounds, (m,).
    """

    name: str
    expression: Any
    lower: Array
    upper: Array


@dataclass(frozen=True)
class Cost:
    """A weighted addend of the objective.

    Attributes:
        name: what it penalises.
        weight: factor; 0 switches the cost off.
        expression: CasADi scalar.
    """

    name: str
    weight: float
    expression: Any


def equality(name: str, expression: Any) -> Constraint:
    """Return the constraint expression = 0; a matrix is taken column by column."""
    zero = np.zeros(expression.numel())
    return Constraint(name, expression.reshape((-1, 1)), zero, zero)


def interval(name: str, expression: Any, lower: Array, upper: Array) -> Constraint:
    """Return the constraint lower <= expression <= upper; bounds broadcast over the columns of (r, c)."""
    shape = expression.shape
    low, high = (np.broadcast_to(bound[:, None], shape).ravel(order="F") for bound in (lower, upper))
    return Constraint(name, expression.reshape((-1, 1)), low, high)
