"""The time grid of the program: intervals aligned with phases, and load nodes in them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadlab.gaits.schedule import BoolArray, ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.footholds import IntArray

_TIME_TOLERANCE = 1e-9  # [s]


@dataclass(frozen=True)
class TimeGrid:
    """n intervals, each within one phase, and N load nodes.

    Deviation from Winkler 2017: there polynomials and load nodes (every 20 ms) ignore the phases. Here each phase is
    divided into equal intervals, so that the feet in contact are constant over an interval. Neighbouring intervals of
    a phase share a node; a contact switch has one node at either side.

    Attributes:
        schedule: contact flags.
        starts_s, durations_s: start and length of each interval, t_k and T_k, (n,) in [s].
        nodes: load nodes of each interval, equally spaced from its start to its end, (n, k).
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
        """Which feet may carry load at each node, (N, feet): c^f of Eq. (19b)."""
        flags: BoolArray = self.schedule.contacts[self.node_phases]
        return flags

    def locate(self, times_s: Array) -> tuple[IntArray, Array]:
        """Return (interval, elapsed fraction in [0, 1]) at ``times_s``, both (s,)."""
        found = np.searchsorted(self.starts_s, times_s + _TIME_TOLERANCE, side="right") - 1
        piece = np.clip(found, 0, self.count - 1)
        return piece, np.clip((times_s - self.starts_s[piece]) / self.durations_s[piece], 0.0, 1.0)


def time_grid(schedule: ContactSchedule, longest_s: float, nodes_per_interval: int) -> TimeGrid:
    """Return the grid of ``schedule``.

    Args:
        schedule: contact flags.
        longest_s: longest interval in [s].
        nodes_per_interval: load nodes of an interval, both ends included, at least 2.
    """
    counts = np.maximum(np.ceil(schedule.durations_s / longest_s - 1e-9).astype(int), 1)
    durations = np.repeat(schedule.durations_s / counts, counts)
    within = np.arange(len(durations)) - np.repeat(np.cumsum(counts) - counts, counts)
    steps = nodes_per_interval - 1
    nodes_per_phase = steps * counts + 1
    first = np.repeat(np.cumsum(nodes_per_phase) - nodes_per_phase, counts) + steps * within
    return TimeGrid(
        schedule=schedule,
        starts_s=np.repeat(schedule.switch_times_s[:-1], counts) + within * durations,
        durations_s=durations,
        nodes=first[:, None] + np.arange(nodes_per_interval),
        node_phases=np.repeat(np.arange(len(counts)), nodes_per_phase),
    )
