"""Exact motion of a linear inverted pendulum whose centre of pressure moves along straight lines."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from quadlab.geometry.curve import CurvePieces, piece_at
from quadlab.geometry.rotations import Array


@dataclass(frozen=True)
class LipCurve(CurvePieces):
    """n pieces c(s) = a + b s + p cosh(w s) + q sinh(w s), each in its local time s.

    It solves c_ddot = w^2 (c - u) for u(s) = a + b s. Outside its span it continues at rest: the end value, with zero
    derivatives.

    Attributes:
        knots: (n + 1,) increasing times in [s].
        coefficients: a, b, p, q of each piece, (n, 4, d).
        rate: w in [1/s].
    """

    rate: float

    @cached_property
    def _coefficient_list(self) -> list[list[list[float]]]:
        lists: list[list[list[float]]] = self.coefficients.tolist()
        return lists

    @cached_property
    def _compiled_motion(self) -> Callable[..., Array]:
        from quadlab.geometry.curve_motion import lip_motion  # noqa: PLC0415

        return lip_motion

    def __call__(self, time_s: float, derivative: int = 0) -> Array:
        """Return the value (or the 1st to 3rd time derivative) at ``time_s``, (d,)."""
        if derivative and not self._spans(time_s):
            return np.zeros(self.dimension)
        piece, local = piece_at(self._knot_list, time_s)
        angle = self.rate * local
        even, odd = math.cosh(angle), math.sinh(angle)
        offset, slope, p, q = self._coefficient_list[piece]
        scale = self.rate**derivative
        first, second = (scale * even, scale * odd) if derivative % 2 == 0 else (scale * odd, scale * even)
        values = [first * pi + second * qi for pi, qi in zip(p, q, strict=True)]
        if derivative == 0:
            values = [value + (a + local * b) for value, a, b in zip(values, offset, slope, strict=True)]
        if derivative == 1:
            values = [value + b for value, b in zip(values, slope, strict=True)]
        return np.array(values)

    def motion(self, time_s: float) -> Array:
        """Return value, first and second time derivative at ``time_s``, (3, d)."""
        return self._compiled_motion(self.knots, self.coefficients, self.rate, time_s)

    def on_pieces(self, pieces: NDArray[np.intp], local_s: Array, derivative: int = 0) -> Array:
        """Return the value (or a derivative) of given pieces at given local times in [s], both (s,); (s, d)."""
        offset, slope, p, q = np.moveaxis(self.coefficients[pieces], 1, 0)
        local = np.asarray(local_s)[:, None]
        even, odd = np.cosh(self.rate * local), np.sinh(self.rate * local)
        first, second = (even, odd) if derivative % 2 == 0 else (odd, even)
        value: Array = self.rate**derivative * (first * p + second * q)
        if derivative == 0:
            value += offset + local * slope
        if derivative == 1:
            value += slope
        return value
