"""Where each foot is over time, as a linear map from the list of all its positions on the ground."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import casadi as ca
import numpy as np

from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.planners.swing import swing_blend
from quadlab.planners.vertex_zmp.grid import IntArray
from quadlab.robots.legs import LEG_COUNT


@dataclass(frozen=True)
class FootholdIndex:
    """Numbers all stances of all legs, leg after leg; each leg begins with the stance of the given start.

    Attributes:
        schedule: contact flags.
    """

    schedule: ContactSchedule

    @cached_property
    def first(self) -> IntArray:
        """Number of the first stance of each leg, (4,)."""
        counts = [len(swings) + 1 for swings in self.schedule.swings]
        return np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(np.intp)

    @property
    def count(self) -> int:
        """Number of all stances M."""
        return self.swing_count + LEG_COUNT

    @property
    def swing_count(self) -> int:
        """Number of all swings: stances that are free."""
        return sum(len(swings) for swings in self.schedule.swings)

    @cached_property
    def free(self) -> IntArray:
        """Numbers of the stances that are variables, (M - 4,)."""
        return np.setdiff1d(np.arange(self.count), self.first)

    @cached_property
    def free_legs(self) -> IntArray:
        """Leg of each free stance, (M - 4,)."""
        return np.searchsorted(self.first, self.free, side="right") - 1

    @cached_property
    def phase_stances(self) -> IntArray:
        """Stance that each leg is in, or is leaving, in each phase, (p, 4)."""
        times = self.schedule.switch_times_s
        middles = 0.5 * (times[:-1] + times[1:])
        completed = [[self.schedule.swing_at(leg, float(t))[0] for leg in range(LEG_COUNT)] for t in middles]
        return np.array(completed, dtype=np.intp) + self.first

    @cached_property
    def free_middles_s(self) -> Array:
        """Middle of the time that each free stance lasts, (M - 4,) in [s]; the end of the plan for the last ones.

        A motion ends at rest, so its last footholds belong under the final pose.
        """
        middles: list[float] = []
        for swings in self.schedule.swings:
            middles += [0.5 * (a.end_s + b.start_s) for a, b in pairwise(swings)]
            middles += [self.schedule.duration_s] * bool(swings)
        return np.array(middles)

    def position_weights(self, leg: int, times_s: Array) -> ca.DM:
        """Return W with foot positions = stances (2, M) @ W at ``times_s``; sparse, (M, s).

        A standing foot is at its stance, a swing foot on the cubic of Eq. (13) between two of them.
        """
        rows: list[int] = []
        columns: list[int] = []
        weights: list[float] = []
        for column, time in enumerate(times_s):
            completed, swing = self.schedule.swing_at(leg, float(time))
            stance = int(self.first[leg]) + completed
            share = 0.0 if swing is None else float(swing_blend((time - swing.start_s) / swing.duration_s))
            rows += [stance] if share == 0.0 else [stance, stance + 1]
            columns += [column] if share == 0.0 else [column, column]
            weights += [1.0] if share == 0.0 else [1.0 - share, share]
        return ca.DM.triplet(rows, columns, ca.DM(weights), self.count, len(times_s))
