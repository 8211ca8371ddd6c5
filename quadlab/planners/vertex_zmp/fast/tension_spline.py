"""CoM motion between two states when the CoP moves along a straight line: exact, and linear in the states."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.footholds import IntArray

_SHORT_ANGLE = 0.02  # w T of an interval of about 5 ms
_SMALL_ANGLE = 0.3  # below this the odd function is summed as a series, to 1e-16


@dataclass(frozen=True)
class TensionSpline:
    """Solutions of c_ddot = w^2 (c - u) with u linear in time, by the states at both ends of each interval.

    With s = t / T in an interval of length T and k = w T they are spanned by 1, s, C(s), S(s),
    C = 2 (cosh(k s) - 1) / k^2 and S = 6 (sinh(k s) - k s) / k^3, which tend to 1, s, s^2, s^3 for short intervals.

    Attributes:
        durations_s: T of each interval, (n,) in [s].
        rate: w = sqrt(g / h) in [1/s].
    """

    durations_s: Array
    rate: float

    @cached_property
    def _from_states(self) -> Array:
        """Coefficients of the four functions from (c_0, v_0, c_1, v_1), (n, 4, 4)."""
        count, length = len(self.durations_s), self.durations_s
        ends = self._functions(np.arange(count), np.ones(count), 0)
        slopes = self._functions(np.arange(count), np.ones(count), 1)
        determinant = ends[:, 2] * slopes[:, 3] - ends[:, 3] * slopes[:, 2]
        zero, one = np.zeros(count), np.ones(count)
        gap = np.stack([-one, -length, one, zero], axis=1)
        turn = np.stack([zero, -length, zero, length], axis=1)
        even = (slopes[:, 3:] * gap - ends[:, 3:] * turn) / determinant[:, None]
        odd = (ends[:, 2:3] * turn - slopes[:, 2:3] * gap) / determinant[:, None]
        first = np.stack([one, zero, zero, zero], axis=1)
        second = np.stack([zero, length, zero, zero], axis=1)
        return np.stack([first, second, even, odd], axis=1)

    def weights(self, intervals: IntArray, fractions: Array, derivative: int = 0) -> Array:
        """Return the share of (c_0, v_0, c_1, v_1) in the CoM or its 1st or 2nd time derivative, (s, 4).

        Args:
            intervals: interval of each sample, (s,).
            fractions: elapsed share of the interval, (s,).
            derivative: 0 to 2.
        """
        functions = self._functions(intervals, fractions, derivative)
        shares: Array = np.einsum("sf,sfj->sj", functions, self._from_states[intervals])
        return shares / self.durations_s[intervals, None] ** derivative

    def cop_weights(self, intervals: IntArray, fractions: Array) -> Array:
        """Return the share of (c_0, v_0, c_1, v_1) in the CoP u = c - c_ddot / w^2, (s, 4)."""
        acceleration = self.weights(intervals, fractions, 2)
        return self.weights(intervals, fractions) - acceleration / self.rate**2

    def row_scales(self, intervals: IntArray) -> Array:
        """Return factors for rows about the CoP, (s,): 1, less for intervals so short that the CoP hardly matters.

        The share of the states in the CoP grows with 1 / (w T)^2.
        """
        scales: Array = np.minimum(1.0, (self.rate * self.durations_s[intervals] / _SHORT_ANGLE) ** 2)
        return scales

    def _functions(self, intervals: IntArray, fractions: Array, derivative: int) -> Array:
        """Return 1, s, C, S or their derivatives by s, (s, 4)."""
        k = self.rate * self.durations_s[intervals]
        angle = k * fractions
        even = 4.0 * (np.sinh(0.5 * angle) / k) ** 2
        slope = 2.0 * np.sinh(angle) / k
        zero, one = np.zeros_like(k), np.ones_like(k)
        if derivative == 0:
            return np.stack([one, fractions, even, _odd(angle) * fractions**3], axis=1)
        if derivative == 1:
            return np.stack([zero, one, slope, 3.0 * even], axis=1)
        return np.stack([zero, zero, 2.0 * np.cosh(angle), 3.0 * slope], axis=1)


def _odd(angle: Array) -> Array:
    """Return 6 (sinh x - x) / x^3."""
    square = angle**2
    series = 1.0 + square / 20.0 * (1.0 + square / 42.0 * (1.0 + square / 72.0 * (1.0 + square / 110.0)))
    safe = np.where(angle > _SMALL_ANGLE, angle, 1.0)
    exact: Array = 6.0 * (np.sinh(safe) - safe) / safe**3
    return np.where(angle > _SMALL_ANGLE, exact, series)
