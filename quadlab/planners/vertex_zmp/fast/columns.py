"""The vector of the reduced program: the only place that knows where a quantity sits in it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadlab.gaits.schedule import BoolArray
from quadlab.planners.vertex_zmp.footholds import FootholdIndex, IntArray
from quadlab.planners.vertex_zmp.grid import TimeGrid


@dataclass(frozen=True)
class Columns:
    """Numbers of all quantities, known and unknown: CoM states at the knots, stances, load shares at the nodes.

    At each node the last foot in contact has no share of its own: it carries what the others leave, Winkler 2017,
    Eq. (19a).

    Attributes:
        grid: time grid.
        footholds: numbering of the stances.
    """

    grid: TimeGrid
    footholds: FootholdIndex

    @cached_property
    def states(self) -> IntArray:
        """CoM position (0) and velocity (1) at each knot, (n + 1, 2, 2 axes)."""
        return np.arange(4 * (self.grid.count + 1)).reshape(-1, 2, 2)

    @cached_property
    def stances(self) -> IntArray:
        """Position of each stance on the ground, (M, 2 axes)."""
        numbers: IntArray = self.states.size + np.arange(2 * self.footholds.count).reshape(-1, 2)
        return numbers

    @cached_property
    def last_feet(self) -> IntArray:
        """The foot at each node that carries the rest, (N,)."""
        contacts = self.grid.node_contacts
        last: IntArray = contacts.shape[1] - 1 - np.argmax(contacts[:, ::-1], axis=1)
        return last

    @cached_property
    def shared(self) -> BoolArray:
        """Which feet have a share of their own at each node, (N, feet)."""
        flags = self.grid.node_contacts.copy()
        flags[np.arange(len(flags)), self.last_feet] = False
        return flags

    @cached_property
    def loads(self) -> IntArray:
        """Load share of each foot at each node, (N, feet); -1 where it has none of its own."""
        numbers = np.full(self.shared.shape, -1, dtype=np.intp)
        numbers[self.shared] = self.states.size + self.stances.size + np.arange(int(self.shared.sum()))
        return numbers

    @cached_property
    def size(self) -> int:
        """Length of the vector."""
        return self.states.size + self.stances.size + int(self.shared.sum())

    @cached_property
    def known(self) -> IntArray:
        """Numbers of what the problem gives: state at both ends and the stances at the start."""
        ends = self.states[[0, -1]].ravel()
        return np.concatenate([ends, self.stances[self.footholds.first].ravel()])
