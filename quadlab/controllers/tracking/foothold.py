"""Where a swinging foot shall land: the plan's foothold, aligned and corrected for balance (Gehring 2017, III-B)."""

import math

import numpy as np

from quadlab.constants import GRAVITY
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled


@compiled
def balance_correction(
    gain: float, speed_limit: float, velocity_error: Array, com_height: float, phase: float
) -> Array:
    """Return the inverted-pendulum correction sqrt(h / g) (v - v_ref), blended in linearly over the swing, (2,) in [m].

    A deviation from Gehring 2017, which corrects the planned positions of the foot in the air by this share: here it is
    the foothold, to which a quintic leads, so that the foot itself follows later in the swing. Planned positions in
    between are not used.

    Args:
        gain: on the correction, dimensionless.
        speed_limit: speed error at which the answer saturates in [m/s].
        velocity_error: measured minus desired CoM velocity, (2,) in [m/s].
        com_height: over the ground in [m]; a fallen robot may have it below, which gives no correction.
        phase: progress of the swing in [0, 1].
    """
    speed = math.hypot(velocity_error[0], velocity_error[1])
    saturation = min(1.0, speed_limit / max(speed, 1e-9))
    return gain * math.sqrt(max(com_height, 0.0) / GRAVITY) * min(phase, 1.0) * saturation * velocity_error


@compiled
def within_reach(foothold: Array, com: Array, yaw: float, nominal: Array, reach: tuple[float, float]) -> Array:
    """Return ``foothold`` moved into the box that the leg can reach.

    Args:
        foothold, com: in the world, (2,) in [m].
        yaw: heading of the base in [rad].
        nominal: nominal foot position relative to the CoM in the heading frame, (2,) in [m].
        reach: half size of the box in the heading frame, forward and sideways in [m].
    """
    cosine, sine = math.cos(yaw), math.sin(yaw)
    x, y = foothold[0] - com[0], foothold[1] - com[1]
    forward = min(max(cosine * x + sine * y, nominal[0] - reach[0]), nominal[0] + reach[0])
    left = min(max(cosine * y - sine * x, nominal[1] - reach[1]), nominal[1] + reach[1])
    return np.array([com[0] + cosine * forward - sine * left, com[1] + sine * forward + cosine * left])
