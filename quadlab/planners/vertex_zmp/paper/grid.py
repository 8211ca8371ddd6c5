"""The time grid of the program: polynomials aligned with phases, and load nodes."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadlab.gaits.schedule import BoolArray, ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.footholds import IntArray

_TIME_TOLERANCE = 1e-9  # [s]


@dataclass(frozen=True)
class PolynomialGrid:
    """n polynomials, each within one phase, and N load nodes at their starts, middles and ends.

    Deviation from Winkler 2017: there polynomials and load nodes (every 20 ms) ignore the phases. Here each phase is
    divided into equal polynomials, so that the feet in contact are constant over a polynomial. Neighbouring
    polynomials of a phase share a node; a contact switch has one node at either side.

    Attributes:
        schedule: contact flags.
        starts_s, durations_s: t_k and T_k of each polynomial, (n,) in [s].
        nodes: load nodes at the start, middle and end of each polynomial, (n, 3).
        node_phases: phase of each load node, (N,).
    """

    schedule: ContactSchedule
    starts_s: Array
    durations_s: Array
    nodes: IntArray
    node_phases: IntArray

    @property
    def count(self) -> int:
        """Number of polynomials n."""
        return len(self.starts_s)

    @property
    def knots_s(self) -> Array:
        """Start of each polynomial and the end of the last, (n + 1,) in [s]."""
        return np.append(self.starts_s, self.starts_s[-1] + self.durations_s[-1])

    @cached_property
    def node_contacts(self) -> BoolArray:
        """Which legs may carry load at each node, (N, 4): c^f of Eq. (19b)."""
        flags: BoolArray = self.schedule.contacts[self.node_phases]
        return flags

    @cached_property
    def node_weights_s(self) -> Array:
        """Weight of each load node in the integral over time by Simpson's rule, (N,) in [s]."""
        weights = np.zeros(len(self.node_phases))
        np.add.at(weights, self.nodes, self.durations_s[:, None] * np.array([1.0, 4.0, 1.0]) / 6.0)
        return weights

    def locate(self, times_s: Array) -> tuple[IntArray, Array]:
        """Return (polynomial, elapsed fraction in [0, 1]) at ``times_s``, both (s,)."""
        found = np.searchsorted(self.starts_s, times_s + _TIME_TOLERANCE, side="right") - 1
        piece = np.clip(found, 0, self.count - 1)
        fraction = np.clip((times_s - self.starts_s[piece]) / self.durations_s[piece], 0.0, 1.0)
        return piece, fraction


def polynomial_grid(schedule: ContactSchedule, longest_s: float) -> PolynomialGrid:
    """Return the grid whose polynomials last at most ``longest_s`` in [s]."""
    counts = np.ceil(schedule.durations_s / longest_s - 1e-9).astype(int)
    counts = np.maximum(counts, 1)
    durations = np.repeat(schedule.durations_s / counts, counts)
    within = np.concatenate([np.arange(count) for count in counts])
    starts = np.repeat(schedule.switch_times_s[:-1], counts) + within * durations
    nodes_per_phase = 2 * counts + 1
    first = np.repeat(np.cumsum(nodes_per_phase) - nodes_per_phase, counts) + 2 * within
    return PolynomialGrid(
        schedule=schedule,
        starts_s=starts,
        durations_s=durations,
        nodes=first[:, None] + np.arange(3),
        node_phases=np.repeat(np.arange(len(counts)), nodes_per_phase),
    )
