"""Limits of the normal forces that rise after touch-down and fall before lift-off (Gehring 2017, III-C b).

The paper limits the norm of the force and lets it rise from zero. Here the limit is one of the normal force, which
bounds the tangential ones through friction, and begins at a share of the weight, so that contact is felt.
"""

from quadlab.controllers.tracking.config import ForceRampConfig
from quadlab.gaits.schedule import ContactSchedule


def ramp_duration(config: ForceRampConfig, schedule: ContactSchedule, leg: int, foothold: int, began_s: float) -> float:
    """Return how long the limit of ``leg`` rises and falls in [s]: a share of the stance under way, as it is planned.

    A leg that never swings has no ramp.

    Args:
        config: the share.
        schedule: of the plan; the last stance of a leg reaches to its end.
        leg: number of the leg.
        foothold: number of the foothold that it stands on.
        began_s: when the first stance of the schedule began in [s]; before time 0 if the plan replaced another.
    """
    swings = schedule.swings[leg]
    if not swings:
        return 0.0
    begin_s = swings[foothold - 1].end_s if foothold else began_s
    end_s = swings[foothold].start_s if foothold < len(swings) else schedule.duration_s
    return config.share_of_stance * (end_s - begin_s)


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
