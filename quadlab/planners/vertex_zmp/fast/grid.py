"""The time grid of the reduced program: intervals aligned with phases, and load nodes at their ends."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadlab.gaits.schedule import BoolArray, ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.footholds import IntArray

_TIME_TOLERANCE = 1e-9  # [s]


@dataclass(frozen=True)
class LoadGrid:
    """n intervals, each within one phase, and N load nodes; loads are linear in time between two nodes.

    Neighbouring intervals of a phase share a node; a contact switch has one node at either side.

    Attributes:
        schedule: contact flags.
        starts_s, durations_s: start and length of each interval, (n,) in [s].
        nodes: load nodes at the start and the end of each interval, (n, 2).
        node_phases: phase of each load node, (N,).
    """

    schedule: ContactSchedule
    starts_s: Array
    durations_s: Array
    nodes: IntArray
    node_phases: IntArray

    @property
    def count(self) -> int:
        """Number of intervals n."""
        return len(self.starts_s)

    @cached_property
    def knots_s(self) -> Array:
        """Start of each interval and the end of the last, (n + 1,) in [s]."""
        return np.append(self.starts_s, self.starts_s[-1] + self.durations_s[-1])

    @cached_property
    def node_contacts(self) -> BoolArray:
        """Which feet carry load at each node, (N, feet)."""
        flags: BoolArray = self.schedule.contacts[self.node_phases]
        return flags

    @cached_property
    def node_places(self) -> tuple[IntArray, Array]:
        """One (interval, elapsed fraction) for each node, both (N,)."""
        intervals = np.empty(len(self.node_phases), dtype=np.intp)
        fractions = np.zeros(len(self.node_phases))
        intervals[self.nodes[:, 1]], fractions[self.nodes[:, 1]] = np.arange(self.count), 1.0
        intervals[self.nodes[:, 0]], fractions[self.nodes[:, 0]] = np.arange(self.count), 0.0
        return intervals, fractions

    @cached_property
    def shared_knots(self) -> IntArray:
        """Intervals whose first node is the last node of the interval before."""
        return np.flatnonzero(self.nodes[1:, 0] == self.nodes[:-1, 1]) + 1

    def locate(self, times_s: Array) -> tuple[IntArray, Array]:
        """Return (interval, elapsed fraction in [0, 1]) at ``times_s``, both (s,)."""
        found = np.searchsorted(self.starts_s, times_s + _TIME_TOLERANCE, side="right") - 1
        piece = np.clip(found, 0, self.count - 1)
        return piece, np.clip((times_s - self.starts_s[piece]) / self.durations_s[piece], 0.0, 1.0)


def load_grid(schedule: ContactSchedule, longest_s: float) -> LoadGrid:
    """Return the grid whose intervals last at most ``longest_s`` in [s]."""
    counts = np.maximum(np.ceil(schedule.durations_s / longest_s - 1e-9).astype(int), 1)
    durations = np.repeat(schedule.durations_s / counts, counts)
    within = np.arange(len(durations)) - np.repeat(np.cumsum(counts) - counts, counts)
    first = np.arange(len(durations)) + np.repeat(np.arange(len(counts)), counts)
    return LoadGrid(
        schedule=schedule,
        starts_s=np.repeat(schedule.switch_times_s[:-1], counts) + within * durations,
        durations_s=durations,
        nodes=np.stack([first, first + 1], axis=1),
        node_phases=np.repeat(np.arange(len(counts)), counts + 1),
    )
