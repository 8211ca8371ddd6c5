"""Switches of contacts between samples: there the plan is made for other times than the checker judges it by."""

import numpy as np

from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.planners.problem import Waypoints

_TIME_TOLERANCE = 1e-6  # [s]
_MOST_SAMPLES = 128


def largest_offset_s(schedule: ContactSchedule, sample_times_s: Array) -> float:
    """Return how far a switch of contacts is from the nearest sample at most, in [s].

    Args:
        schedule: of the whole motion.
        sample_times_s: of the whole motion, (M,) in [s].
    """
    switches = schedule.switch_times_s[1:-1]
    distances = np.abs(switches[:, None] - sample_times_s[None, :]).min(axis=1)
    return float(distances.max(initial=0.0))


def samples_that_meet(schedule: ContactSchedule, waypoints: Waypoints, fewest: int) -> int | None:
    """Return the smallest number of samples a cycle, ``fewest`` or more, with one at every switch; None if too many."""
    borders = np.append(waypoints.times_s, schedule.duration_s)
    switches = schedule.switch_times_s[1:-1]
    cycles = np.searchsorted(borders, switches + _TIME_TOLERANCE) - 1
    starts, durations = borders[cycles], borders[cycles + 1] - borders[cycles]
    for count in range(fewest, _MOST_SAMPLES + 1):
        places = (switches - starts) / durations * count
        if (np.abs(places - np.round(places)) * durations / count < _TIME_TOLERANCE).all():
            return count
    return None


def beside_samples(schedule: ContactSchedule, waypoints: Waypoints, sample_times_s: Array, samples: int) -> str:
    """Return in words how far switches lie beside samples and what would mend it; empty if they do not.

    Args:
        schedule: of the whole motion.
        waypoints: at the borders of the cycles.
        sample_times_s: of the whole motion, (M,) in [s].
        samples: of a cycle.
    """
    offset_s = largest_offset_s(schedule, sample_times_s)
    if offset_s < _TIME_TOLERANCE:
        return ""
    said = f"contact switches lie up to {1e3 * offset_s:.3g} ms beside samples"
    count = samples_that_meet(schedule, waypoints, samples)
    return said if count is None else f"{said}; planner.samples_per_cycle={count} would meet them"
