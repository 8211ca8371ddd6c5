"""Where each foot is over time, as a linear map from the list of all its positions on the ground."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.planners.swing import swing_blend

IntArray = NDArray[np.intp]


@dataclass(frozen=True)
class FootholdIndex:
    """Numbers all stances of all feet, foot after foot; each foot begins with the stance of the given start.

    Attributes:
        schedule: contact flags of F feet.
    """

    schedule: ContactSchedule

    @property
    def foot_count(self) -> int:
        """Number of feet F."""
        return len(self.schedule.swings)

    @cached_property
    def first(self) -> IntArray:
        """Number of the first stance of each foot, (F,)."""
        counts = [len(swings) + 1 for swings in self.schedule.swings]
        return np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(np.intp)

    @property
    def count(self) -> int:
        """Number of all stances M."""
        return self.swing_count + self.foot_count

    @property
    def swing_count(self) -> int:
        """Number of all swings: stances that are free."""
        return sum(len(swings) for swings in self.schedule.swings)

    @cached_property
    def free(self) -> IntArray:
        """Numbers of the stances that are variables, (M - F,)."""
        return np.setdiff1d(np.arange(self.count), self.first)

    @cached_property
    def free_legs(self) -> IntArray:
        """Foot of each free stance, (M - F,)."""
        return np.searchsorted(self.first, self.free, side="right") - 1

    @cached_property
    def phase_stances(self) -> IntArray:
        """Stance that each foot is in, or is leaving, in each phase, (p, F)."""
        times = self.schedule.switch_times_s
        middles = 0.5 * (times[:-1] + times[1:])
        completed = [
            np.searchsorted([swing.end_s for swing in swings], middles) if swings else np.zeros(len(middles), np.intp)
            for swings in self.schedule.swings
        ]
        return np.stack(completed, axis=1) + self.first

    @cached_property
    def free_middles_s(self) -> Array:
        """Middle of the time that each free stance lasts, (M - F,) in [s]; the end of the plan for the last ones.

        A motion ends at rest, so its last footholds belong under the final pose.
        """
        middles: list[float] = []
        for swings in self.schedule.swings:
            middles += [0.5 * (a.end_s + b.start_s) for a, b in pairwise(swings)]
            middles += [self.schedule.duration_s] * bool(swings)
        return np.array(middles)

    def nominal_places(self, nominal_feet: Array, yaws: Array) -> Array:
        """Return where the foot of each free stance is in the nominal stance around the CoM, (M - F, 2) in [m].

        Args:
            nominal_feet: of all feet in the heading frame, (F, 2) in [m].
            yaws: heading in each free stance, (M - F,) in [rad].
        """
        cosine, sine = np.cos(yaws), np.sin(yaws)
        forward, left = nominal_feet[self.free_legs].T
        return np.stack([cosine * forward - sine * left, sine * forward + cosine * left], axis=1)

    def position_shares(self, leg: int, times_s: Array) -> tuple[IntArray, Array]:
        """Return (stance, share of the next one) at ``times_s``, both (s,).

        A standing foot is at its stance, a swing foot on the cubic of Eq. (13) between two of them.
        """
        swings = self.schedule.swings[leg]
        if not swings:
            return np.full(len(times_s), self.first[leg]), np.zeros(len(times_s))
        starts, ends = np.array([(swing.start_s, swing.end_s) for swing in swings]).T
        landed = np.searchsorted(ends, times_s + 1e-9, side="right")
        swing = np.minimum(landed, len(swings) - 1)
        fraction = np.clip((times_s - starts[swing]) / (ends - starts)[swing], 0.0, 1.0)
        return self.first[leg] + landed, np.where(landed < len(swings), swing_blend(fraction), 0.0)
