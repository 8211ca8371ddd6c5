"""When which foot touches the ground: phases of constant contact, for any number of strides."""

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from quadlab.errors import QuadlabError
from quadlab.geometry.rotations import Array

BoolArray = NDArray[np.bool_]
_TIME_TOLERANCE = 1e-9  # [s]


@dataclass(frozen=True)
class Swing:
    """One swing of one leg, from lift-off to touch-down, times in [s]."""

    start_s: float
    end_s: float

    @property
    def duration_s(self) -> float:
        """Time in the air in [s]."""
        return self.end_s - self.start_s


@dataclass(frozen=True)
class ContactSchedule:
    """Contact flags c^f(t) as phases; the only form in which timing travels through quadlab.

    Attributes:
        durations_s: (p,) positive phase durations in [s].
        contacts: (p, 4) True where the leg (order ``LEGS``) stands; neighbouring phases may be equal.
    """

    durations_s: Array
    contacts: BoolArray

    @cached_property
    def switch_times_s(self) -> Array:
        """Start of each phase and the end of the last, (p + 1,) in [s]."""
        return np.concatenate([[0.0], np.cumsum(self.durations_s)])

    @property
    def duration_s(self) -> float:
        """Length of the schedule in [s]."""
        return float(self.switch_times_s[-1])

    @cached_property
    def swings(self) -> tuple[tuple[Swing, ...], ...]:
        """Swings of each leg in order of time; phases that follow each other in the air are one swing."""
        return tuple(self._swings_of(leg) for leg in range(self.contacts.shape[1]))

    @cached_property
    def _switch_list(self) -> list[float]:
        return [float(time) for time in self.switch_times_s]

    @cached_property
    def _swing_starts(self) -> list[list[float]]:
        return [[swing.start_s for swing in swings] for swings in self.swings]

    def phase_at(self, time_s: float) -> int:
        """Return the phase that holds at ``time_s``; a switch belongs to the phase that begins."""
        index = bisect_right(self._switch_list, time_s + _TIME_TOLERANCE) - 1
        return min(max(index, 0), len(self.durations_s) - 1)

    def contacts_at(self, time_s: float) -> BoolArray:
        """Return which legs stand at ``time_s``, (4,)."""
        flags: BoolArray = self.contacts[self.phase_at(time_s)]
        return flags

    def swing_at(self, leg: int, time_s: float) -> tuple[int, Swing | None]:
        """Return (number of swings that ``leg`` has completed, the swing under way at ``time_s`` or None)."""
        count = bisect_right(self._swing_starts[leg], time_s + _TIME_TOLERANCE)
        if count == 0:
            return 0, None
        last = self.swings[leg][count - 1]
        return (count - 1, last) if time_s < last.end_s - _TIME_TOLERANCE else (count, None)

    def after(self, time_s: float) -> "ContactSchedule":
        """Return what is left of the schedule at ``time_s`` in [s], which becomes its time 0.

        A swing under way begins at its time 0 and has its remaining duration.

        Raises:
            QuadlabError: if nothing is left.
        """
        if not time_s < self.duration_s - _TIME_TOLERANCE:
            raise QuadlabError(f"schedule: nothing is left at {time_s:g} s, it ends at {self.duration_s:g} s")
        phase = self.phase_at(time_s)
        durations = self.durations_s[phase:].copy()
        durations[0] = self.switch_times_s[phase + 1] - max(time_s, 0.0)
        return ContactSchedule(durations, self.contacts[phase:].copy())

    def _swings_of(self, leg: int) -> tuple[Swing, ...]:
        found: list[Swing] = []
        times = self.switch_times_s
        for phase, stands in enumerate(self.contacts[:, leg]):
            if stands:
                continue
            if phase and not self.contacts[phase - 1, leg]:
                found[-1] = Swing(found[-1].start_s, float(times[phase + 1]))
            else:
                found.append(Swing(float(times[phase]), float(times[phase + 1])))
        return tuple(found)
