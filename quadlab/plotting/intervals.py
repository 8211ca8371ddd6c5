"""Flags over time as intervals."""

from typing import NamedTuple

import numpy as np

from quadlab.gaits.schedule import BoolArray, ContactSchedule
from quadlab.geometry.rotations import Array


class Interval(NamedTuple):
    """From ``start_s`` to ``end_s`` in [s]."""

    start_s: float
    end_s: float

    @property
    def duration_s(self) -> float:
        """Length in [s]."""
        return self.end_s - self.start_s


def intervals_where(times_s: Array, flags: BoolArray, end_s: float) -> list[Interval]:
    """Return when ``flags`` hold; each sample holds until the next one.

    Args:
        times_s: increasing, (n,) in [s].
        flags: at these times, (n,).
        end_s: until when the last sample holds in [s].
    """
    edges = np.diff(np.concatenate([[False], flags, [False]]).astype(int))
    bounds = np.append(times_s, end_s)
    starts, ends = bounds[np.flatnonzero(edges > 0)], bounds[np.flatnonzero(edges < 0)]
    return [Interval(float(start), float(end)) for start, end in zip(starts, ends, strict=True)]


def stance_intervals(schedule: ContactSchedule, leg: int) -> list[Interval]:
    """Return when leg number ``leg`` stands according to ``schedule``."""
    return intervals_where(schedule.switch_times_s[:-1], schedule.contacts[:, leg], schedule.duration_s)
