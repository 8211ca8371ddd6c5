"""What every curve over time can do, whatever its pieces are made of."""

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from quadlab.geometry.rotations import Array


class Curve(Protocol):
    """A curve of n pieces, each in its local time; outside its span it continues at rest."""

    @property
    def knots(self) -> Array:
        """Times at which pieces begin and the end of the last, (n + 1,) increasing in [s]."""
        ...

    @property
    def dimension(self) -> int:
        """Number of components d of the curve."""
        ...

    @property
    def span(self) -> tuple[float, float]:
        """First and last knot in [s]."""
        ...

    def __call__(self, time_s: float, derivative: int = 0) -> Array:
        """Return the value (or the 1st to 3rd time derivative) at ``time_s``, (d,)."""
        ...

    def motion(self, time_s: float) -> Array:
        """Return value, first and second time derivative at ``time_s``, (3, d)."""
        ...

    def on_pieces(self, pieces: NDArray[np.intp], local_s: Array, derivative: int = 0) -> Array:
        """Return the value (or a derivative) of given pieces at given local times in [s], both (s,); (s, d)."""
        ...


@dataclass(frozen=True)
class CurvePieces:
    """What the curves made of n pieces have in common.

    Attributes:
        knots: (n + 1,) increasing times in [s].
        coefficients: of each piece, (n, k, d).
    """

    knots: Array
    coefficients: Array

    @cached_property
    def _knot_list(self) -> list[float]:
        return [float(knot) for knot in self.knots]

    @property
    def dimension(self) -> int:
        """Number of components d of the curve."""
        return int(self.coefficients.shape[2])

    @property
    def span(self) -> tuple[float, float]:
        """First and last knot in [s]."""
        return self._knot_list[0], self._knot_list[-1]

    def _spans(self, time_s: float) -> bool:
        return self._knot_list[0] <= time_s <= self._knot_list[-1]


def piece_at(knots: list[float], time_s: float) -> tuple[int, float]:
    """Return (piece, local time in [s]) that hold at ``time_s``; a knot belongs to the later piece."""
    inside = min(max(time_s, knots[0]), knots[-1])
    piece = min(bisect_right(knots, inside) - 1, len(knots) - 2)
    return piece, inside - knots[piece]
