"""A priority level: linear equalities and two-sided inequalities of equal rank, and the stacked form of many levels."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quadlab.errors import QuadlabError
from quadlab.geometry.rotations import Array

IndexArray = NDArray[np.int64]
SideArray = NDArray[np.int8]


class HierarchyError(QuadlabError, ValueError):
    """A hierarchy that is malformed before the solver sees it."""


@dataclass(frozen=True)
class Level:
    """All tasks of one priority: lower <= matrix @ x <= upper, row by row, as well as possible.

    This is the task T of Bellicoso 2016, Eq. (8), with both kinds of rows in one matrix: a row with ``lower == upper``
    is an equality, every other row a two-sided inequality. Units belong to the caller; rows of one level are weighed
    against each other by their scale.

    Attributes:
        name: unique in its hierarchy; names the level in the solution.
        matrix: (m, n); m = 0 is legal.
        lower: (m,), -inf where there is no lower bound.
        upper: (m,), +inf where there is no upper bound.

    Raises:
        HierarchyError: if shapes do not fit, a number is not finite, or a lower bound lies above its upper bound.
    """

    name: str
    matrix: Array
    lower: Array
    upper: Array

    def __post_init__(self) -> None:
        for field in ("matrix", "lower", "upper"):
            object.__setattr__(self, field, np.asarray(getattr(self, field), dtype=np.float64))
        self._check_shapes()
        self._check_numbers()

    def _check_shapes(self) -> None:
        if self.matrix.ndim != 2:
            raise HierarchyError(f"level '{self.name}': matrix must be (m, n), has shape {self.matrix.shape}")
        for field, bound in (("lower", self.lower), ("upper", self.upper)):
            if bound.shape != self.matrix.shape[:1]:
                expected = self.matrix.shape[:1]
                raise HierarchyError(f"level '{self.name}': {field} must have shape {expected}, has {bound.shape}")

    def _check_numbers(self) -> None:
        legal = np.isfinite(self.matrix).all(axis=1) & (self.lower < np.inf) & (self.upper > -np.inf)
        if not legal.all():
            row = int(np.flatnonzero(~legal)[0])
            raise HierarchyError(
                f"level '{self.name}', row {row}: expected finite coefficients and bounds that are finite or open, "
                f"has {self.matrix[row]} in [{self.lower[row]}, {self.upper[row]}]"
            )
        if (self.lower > self.upper).any():
            row = int(np.flatnonzero(self.lower > self.upper)[0])
            raise HierarchyError(
                f"level '{self.name}', row {row}: lower bound {self.lower[row]:g} lies above upper {self.upper[row]:g}"
            )

    def violation(self, x: Array) -> Array:
        """Return by how much each row misses its interval at ``x`` (n,): (m,), positive above, negative below.

        For an equality this is matrix @ x - b, the slack w of Bellicoso 2016, Eq. (8); for a satisfied inequality 0.
        """
        values = self.matrix @ x
        above: Array = np.maximum(values - self.upper, 0.0) + np.minimum(values - self.lower, 0.0)
        return above


class StackedLevels(NamedTuple):
    """All levels of a hierarchy as the compiled solver reads them.

    A named tuple, since it is made in every tick and takes half the time of a frozen dataclass.

    Attributes:
        matrix: (m, n) C-contiguous, rows of all levels, highest priority first.
        lower, upper: (m,).
        breaks: (levels + 1,) row where each level begins, and the number of rows at the end.
    """

    matrix: Array
    lower: Array
    upper: Array
    breaks: IndexArray


def stack(levels: Sequence[Level]) -> StackedLevels:
    """Return the stacked form of ``levels``, highest priority first.

    Raises:
        HierarchyError: if there is no level, the number of columns differs or is zero, or a name occurs twice.
    """
    if not levels:
        raise HierarchyError("hierarchy: expected at least one level, has none")
    columns = sorted({level.matrix.shape[1] for level in levels})
    if len(columns) != 1 or columns[0] == 0:
        raise HierarchyError(f"hierarchy: every level needs the same number of columns, at least one; has {columns}")
    names = [level.name for level in levels]
    if len(set(names)) != len(names):
        raise HierarchyError(f"hierarchy: level names must differ; has {', '.join(names)}")
    return StackedLevels(
        matrix=np.ascontiguousarray(np.concatenate([level.matrix for level in levels])),
        lower=np.concatenate([level.lower for level in levels]),
        upper=np.concatenate([level.upper for level in levels]),
        breaks=np.cumsum([0, *(len(level.lower) for level in levels)], dtype=np.int64),
    )


def unstack(levels: StackedLevels, names: Sequence[str]) -> list[Level]:
    """Return the levels of a stacked form under ``names``, highest priority first."""
    ends = zip(names, levels.breaks[:-1], levels.breaks[1:], strict=True)
    return [
        Level(name, levels.matrix[first:last], levels.lower[first:last], levels.upper[first:last])
        for name, first, last in ends
    ]
