"""Where a swinging foot shall land: the plan's foothold, aligned and corrected for balance (Gehring 2017, III-B)."""

import math

import numpy as np

from quadlab.controllers.tracking.config import SwingConfig
from quadlab.geometry.rotations import Array
from quadlab.planners.problem import GRAVITY


def balance_correction(config: SwingConfig, velocity_error: Array, com_height: float, phase: float) -> Array:
    """Return the inverted-pendulum correction sqrt(h / g) (v - v_ref), blended in linearly over the swing, (2,) in [m].

    Args:
        config: gain and the speed error at which the answer saturates.
        velocity_error: measured minus desired CoM velocity, (2,) in [m/s].
        com_height: over the ground in [m]; a fallen robot may have it below, which gives no correction.
        phase: progress of the swing in [0, 1].
    """
    speed = math.hypot(*velocity_error.tolist())
    saturation = min(1.0, config.feedback_speed_limit_mps / max(speed, 1e-9))
    return config.feedback * math.sqrt(max(com_height, 0.0) / GRAVITY) * min(phase, 1.0) * saturation * velocity_error


def within_reach(foothold: Array, com: Array, yaw: float, nominal: Array, reach: tuple[float, float]) -> Array:
    """Return ``foothold`` moved into the box that the leg can reach.

    Args:
        foothold, com: in the world, (2,) in [m].
        yaw: heading of the base in [rad].
        nominal: nominal foot position relative to the CoM in the heading frame, (2,) in [m].
        reach: half size of the box in the heading frame, forward and sideways in [m].
    """
    cosine, sine = math.cos(yaw), math.sin(yaw)
    (x, y), (com_x, com_y), (ahead, aside) = foothold.tolist(), com.tolist(), nominal.tolist()
    forward = cosine * (x - com_x) + sine * (y - com_y)
    left = -sine * (x - com_x) + cosine * (y - com_y)
    forward = min(max(forward, ahead - reach[0]), ahead + reach[0])
    left = min(max(left, aside - reach[1]), aside + reach[1])
    return np.array([com_x + cosine * forward - sine * left, com_y + sine * forward + cosine * left])
