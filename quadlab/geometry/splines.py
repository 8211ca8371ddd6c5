"""Piecewise polynomials and the quintic that joins two states."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from quadlab.geometry.curve import CurvePieces, piece_at
from quadlab.geometry.rotations import Array


@dataclass(frozen=True)
class PiecewisePolynomial(CurvePieces):
    """A curve of n polynomials, each in its local time.

    Outside its span it continues at rest: the end value, with zero derivatives.

    Attributes:
        knots: (n + 1,) increasing times in [s].
        coefficients: (n, degree + 1, d); entry [k, i] multiplies (t - knots[k])**i.
    """

    @cached_property
    def _derivatives(self) -> list[Array]:
        tables = [np.ascontiguousarray(self.coefficients, dtype=np.float64)]  # compiled code takes tables of one layout
        for _ in range(3):
            last = tables[-1]
            powers = np.arange(1, last.shape[1])[None, :, None]
            tables.append(last[:, 1:] * powers if last.shape[1] > 1 else np.zeros_like(last[:, :1]))
        return tables

    @cached_property
    def _derivative_lists(self) -> list[list[list[list[float]]]]:
        """The coefficients as numbers of Python, which are faster than arrays where one time is asked for."""
        return [table.tolist() for table in self._derivatives]

    @cached_property
    def _compiled_motion(self) -> Callable[..., Array]:
        from quadlab.geometry.curve_motion import spline_motion  # noqa: PLC0415

        return spline_motion

    def __call__(self, time_s: float, derivative: int = 0) -> Array:
        """Return the value (or the 1st to 3rd time derivative) at ``time_s``, (d,)."""
        if derivative and not self._spans(time_s):
            return np.zeros(self.dimension)
        return np.array(self._evaluate(*self.locate(time_s), derivative))

    def motion(self, time_s: float) -> Array:
        """Return value, first and second time derivative at ``time_s``, (3, d)."""
        values, rates, accelerations = self._derivatives[:3]
        return self._compiled_motion(self.knots, values, rates, accelerations, time_s)

    def _evaluate(self, piece: int, local_s: float, derivative: int) -> list[float]:
        """Return a derivative of one polynomial by Horner's scheme."""
        table = self._derivative_lists[derivative][piece]
        values = table[-1]
        for row in table[-2::-1]:
            values = [value * local_s + coefficient for value, coefficient in zip(values, row, strict=True)]
        return values

    def on_pieces(self, pieces: NDArray[np.intp], local_s: Array, derivative: int = 0) -> Array:
        """Return the value (or a derivative) of given pieces at given local times in [s], both (s,); (s, d)."""
        table = self._derivatives[derivative][pieces]
        local = np.asarray(local_s)[:, None]
        value: Array = table[:, -1]
        for power in range(table.shape[1] - 2, -1, -1):
            value = value * local + table[:, power]
        return value

    def locate(self, time_s: float) -> tuple[int, float]:
        """Return (piece, local time in [s]) that hold at ``time_s``; a knot belongs to the later piece."""
        return piece_at(self._knot_list, time_s)


def quintic_between(start: Array, end: Array, duration_s: float) -> Array:
    """Return the coefficients, (6, d) ascending powers, of the quintic Hermite polynomial between two states.

    Args:
        start: position, velocity and acceleration at time 0, (3, d).
        end: the same at time ``duration_s``, (3, d).
        duration_s: duration in [s], positive.
    """
    t = duration_s
    p0, v0, a0 = start
    p1, v1, a1 = end
    delta = p1 - p0
    c3 = (20 * delta - (8 * v1 + 12 * v0) * t - (3 * a0 - a1) * t**2) / (2 * t**3)
    c4 = (-30 * delta + (14 * v1 + 16 * v0) * t + (3 * a0 - 2 * a1) * t**2) / (2 * t**4)
    c5 = (12 * delta - 6 * (v1 + v0) * t - (a0 - a1) * t**2) / (2 * t**5)
    return np.stack([p0, v0, 0.5 * a0, c3, c4, c5])
