"""Limits of the normal forces that rise after touch-down and fall before lift-off (Gehring 2017, III-C b)."""

from itertools import pairwise

import numpy as np

from quadlab.controllers.tracking.config import ForceRampConfig
from quadlab.gaits.schedule import ContactSchedule


def ramp_duration(config: ForceRampConfig, schedule: ContactSchedule, leg: int) -> float:
    """Return how long the limit of ``leg`` rises and falls in [s]: a share of its median stance between two swings."""
    swings = schedule.swings[leg]
    stances = [after.start_s - before.end_s for before, after in pairwise(swings)]
    return config.share_of_stance * float(np.median(stances)) if stances else 0.0


def normal_force_limit(
    config: ForceRampConfig, weight: float, ramp_s: float, since_touch_down_s: float, until_lift_off_s: float
) -> float:
    """Return the largest normal force of a standing leg in [N].

    Args:
        config: shares.
        weight: of the robot in [N].
        ramp_s: duration of each ramp in [s].
        since_touch_down_s: infinite for a leg that has not swung yet, in [s].
        until_lift_off_s: infinite for a leg that will not swing any more, negative for one that has to wait with it,
            whose limit rises again since it is needed; in [s].
    """
    full = config.maximum_weight_share * weight
    nearest = max(0.0, min(since_touch_down_s, abs(until_lift_off_s)))
    if nearest >= ramp_s:
        return full
    least = config.initial_weight_share * weight
    return least + (full - least) * nearest / ramp_s
