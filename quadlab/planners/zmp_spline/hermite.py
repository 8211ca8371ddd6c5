"""The CoM as quintic Hermite segments: positions, velocities and accelerations at knots are the variables."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import quintic_between

IntArray = NDArray[np.intp]
ORDERS = 3
"""Position, velocity and acceleration of a knot."""


@dataclass(frozen=True)
class HermiteGrid:
    """n segments, each within one phase of the schedule; neighbours share a knot, so the curve is C2 by construction.

    The vector of all knot states is ordered by knot, then order of derivative, then axis.

    Attributes:
        knots_s: starts of the segments and the end of the last, (n + 1,) in [s].
        phases: phase of each segment, (n,).
    """

    knots_s: Array
    phases: IntArray

    @property
    def count(self) -> int:
        """Number of segments n."""
        return len(self.phases)

    @property
    def size(self) -> int:
        """Number of knot states of both axes."""
        return 2 * ORDERS * (self.count + 1)

    @cached_property
    def durations_s(self) -> Array:
        """Length of each segment, (n,) in [s]."""
        return np.diff(self.knots_s)

    @cached_property
    def bases(self) -> Array:
        """Powers by knot states of each segment: coefficients = bases[k] @ (p0, v0, a0, p1, v1, a1), (n, 6, 6)."""
        unit = np.eye(2 * ORDERS)
        return np.array([quintic_between(unit[:ORDERS], unit[ORDERS:], float(t)) for t in self.durations_s])

    def column(self, knot: int, order: int, axis: int) -> int:
        """Return the column of one knot state."""
        return (knot * ORDERS + order) * 2 + axis

    def coefficients(self, states: Array) -> Array:
        """Return the polynomials of a vector of all knot states, (n, 6 ascending powers, 2)."""
        knots = states.reshape(self.count + 1, ORDERS, 2)
        ends = np.concatenate([knots[:-1], knots[1:]], axis=1)
        polynomials: Array = np.einsum("nij,nja->nia", self.bases, ends)
        return polynomials

    def weights(self, segments: IntArray, local_s: Array, derivative: int) -> Array:
        """Return how six knot states of its segment make up the curve at each sample, (s, 6).

        Args:
            segments: segment of each sample, (s,).
            local_s: time since its start, (s,) in [s].
            derivative: order of the time derivative.
        """
        powers = np.arange(2 * ORDERS)
        factors = np.array([np.prod(power - np.arange(derivative)) for power in powers], dtype=float)
        monomials = factors * np.asarray(local_s)[:, None] ** np.maximum(powers - derivative, 0)
        weights: Array = np.einsum("si,sij->sj", monomials, self.bases[segments])
        return weights

    def rows(self, segments: IntArray, weights: Array, directions: Array) -> csr_array:
        """Return rows direction . (weights on both axes) over all knot states, (s, size).

        Args:
            segments: (s,).
            weights: of six knot states, (s, 6).
            directions: share of x and y in each row, (s, 2).
        """
        columns = 2 * ORDERS * np.asarray(segments)[:, None] + np.arange(4 * ORDERS)
        values = (weights[:, :, None] * directions[:, None, :]).reshape(len(weights), -1)
        pointers = np.arange(0, values.size + 1, 4 * ORDERS)
        return csr_array((values.ravel(), columns.ravel(), pointers), shape=(len(weights), self.size))


def hermite_grid(schedule: ContactSchedule, longest_s: float) -> HermiteGrid:
    """Return the grid whose segments last at most ``longest_s`` in [s]."""
    counts = np.maximum(np.ceil(schedule.durations_s / longest_s - 1e-9).astype(int), 1)
    starts = [
        start + duration / count * np.arange(count)
        for start, duration, count in zip(schedule.switch_times_s[:-1], schedule.durations_s, counts, strict=True)
    ]
    knots = np.append(np.concatenate(starts), schedule.duration_s)
    return HermiteGrid(knots, np.repeat(np.arange(len(counts)), counts))


@dataclass(frozen=True)
class GridSamples:
    """Times at which constraints hold; an inner knot belongs to both its segments.

    Attributes:
        segments: (s,).
        local_s: time since the start of the segment, (s,) in [s].
        times_s: (s,) in [s].
        spacing_s: time that each sample stands for, (s,) in [s].
    """

    segments: IntArray
    local_s: Array
    times_s: Array
    spacing_s: Array


def grid_samples(grid: HermiteGrid, period_s: float) -> GridSamples:
    """Return samples at most ``period_s`` in [s] apart, both ends of every segment included."""
    counts = np.ceil(grid.durations_s / period_s - 1e-9).astype(int).clip(1)
    local = [duration * np.arange(n + 1) / n for duration, n in zip(grid.durations_s, counts, strict=True)]
    spacing = [np.full(n + 1, duration / (n + 1)) for duration, n in zip(grid.durations_s, counts, strict=True)]
    segments = np.repeat(np.arange(grid.count), counts + 1)
    local_s = np.concatenate(local)
    return GridSamples(segments, local_s, grid.knots_s[segments] + local_s, np.concatenate(spacing))
