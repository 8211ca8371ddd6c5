"""What every curve over time can do, whatever its pieces are made of."""

from bisect import bisect_right
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


def piece_at(knots: list[float], time_s: float) -> tuple[int, float]:
    """Return (piece, local time in [s]) that hold at ``time_s``; a knot belongs to the later piece."""
    inside = min(max(time_s, knots[0]), knots[-1])
    piece = min(bisect_right(knots, inside) - 1, len(knots) - 2)
    return piece, inside - knots[piece]
