"""Samples in time: when they are, who stands between them, who may carry at them, how high feet are."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.strides import Cycle
from quadlab.robots.legs import LEG_COUNT


@dataclass(frozen=True)
class CycleSpan:
    """Where a cycle lies among the samples.

    Attributes:
        cycle: the cycle.
        first, last: samples with which it begins and ends; the last one is the first of the next cycle.
        heading: commanded heading at its beginning in [rad].
    """

    cycle: Cycle
    first: int
    last: int
    heading: float


@dataclass(frozen=True)
class SampleGrid:
    """The samples of a chain of cycles, each cycle once.

    The flags c_{k,i} of the paper belong to the interval that ends with sample i: then Eq. (4) says that a foot does
    not move while it stands. A swing begins and ends at the samples nearest to the switches of the schedule, at most
    half a sample period beside them; the checker judges the plan by the exact schedule.

    Attributes:
        times_s: (N,) in [s]; repetitions left out.
        contacts: which legs stand in the interval that begins with each sample, (N - 1, 4).
        spans: the cycles.
    """

    times_s: Array
    contacts: BoolArray
    spans: tuple[CycleSpan, ...]

    @property
    def samples(self) -> int:
        """Number N of samples."""
        return len(self.times_s)

    @cached_property
    def periods_s(self) -> Array:
        """Distances of the samples, (N - 1,) in [s]."""
        periods: Array = np.diff(self.times_s)
        return periods

    @cached_property
    def unrolled_times_s(self) -> Array:
        """When the samples are with every cycle as often as it runs, (M,) in [s]."""
        runs = [self.periods_s[span.first : span.last] for span in self.spans for _ in range(span.cycle.repeats)]
        times: Array = np.cumsum(np.concatenate([[0.0], *runs]))
        return times

    @property
    def ends_at_rest(self) -> bool:
        """Whether the motion stops; if not, its last cycle runs for ever."""
        return not self.spans[-1].cycle.periodic

    @cached_property
    def wraps(self) -> tuple[CycleSpan, ...]:
        """The cycles whose end is followed by their own beginning."""
        last = len(self.spans) - 1
        periodic = [(number, span) for number, span in enumerate(self.spans) if span.cycle.periodic]
        return tuple(span for number, span in periodic if span.cycle.repeats > 1 or number == last)

    @cached_property
    def support(self) -> BoolArray:
        """Which feet may carry at each sample, (N, 4).

        A sample lies between two intervals: the feet that stand in both, or, where none does, those that stand in
        either. The CoP then stays within the support between the samples too.
        """
        before = np.vstack([self.contacts[:1], self.contacts])
        after = np.vstack([self.contacts, self._contacts_after_end()])
        both = before & after
        return np.where(both.any(axis=1, keepdims=True), both, before | after)

    def _contacts_after_end(self) -> BoolArray:
        last = self.spans[-1]
        return self.contacts[-1:] if self.ends_at_rest else self.contacts[last.first : last.first + 1]

    def foot_heights(self, clearance: float) -> Array:
        """Return heights of the feet over the ground, (N, 4) in [m]: 16 u^2 (1 - u)^2 times the clearance in a swing.

        Args:
            clearance: height in the middle of a swing in [m].
        """
        heights = np.zeros((self.samples, LEG_COUNT))
        for leg in range(LEG_COUNT):
            edges = np.flatnonzero(np.diff(np.r_[True, self.contacts[:, leg], True].astype(int)))
            for lift_off, touch_down in edges.reshape(-1, 2):
                times = self.times_s[lift_off : touch_down + 1]
                share = (times - times[0]) / (times[-1] - times[0])
                heights[lift_off : touch_down + 1, leg] = clearance * 16.0 * share**2 * (1.0 - share) ** 2
        return heights


def sample_grid(cycles: Sequence[Cycle], heading: float) -> SampleGrid:
    """Return the samples of a chain of cycles that begins with ``heading`` in [rad]."""
    times, spans = [0.0], []
    for cycle in cycles:
        first, samples = len(times) - 1, len(cycle.contacts)
        times += [times[first] + float(elapsed) for elapsed in np.cumsum(cycle.periods_s)]
        spans.append(CycleSpan(cycle, first, first + samples, heading))
        heading += float(cycle.increment[2])
    contacts = np.concatenate([cycle.contacts for cycle in cycles])
    return SampleGrid(np.array(times), contacts, tuple(spans))
