"""Where a swinging foot shall land: the plan's foothold, aligned and corrected for balance (Gehring 2017, III-B)."""

import math

import numpy as np

from quadlab.controllers.tracking.config import SwingConfig
from quadlab.geometry.rotations import Array, rotation_2d
from quadlab.planners.problem import GRAVITY


def balance_correction(config: SwingConfig, velocity_error: Array, com_height: float, phase: float) -> Array:
    """Return the inverted-pendulum correction sqrt(h / g) (v - v_ref), blended in linearly over the swing, (2,) in [m].

    Args:
        config: gain and the speed error at which the answer saturates.
        velocity_error: measured minus desired CoM velocity, (2,) in [m/s].
        com_height: over the ground in [m]; a fallen robot may have it below, which gives no correction.
        phase: progress of the swing in [0, 1].
    """
    speed = float(np.hypot(*velocity_error))
    saturation = min(1.0, config.feedback_speed_limit_mps / max(speed, 1e-9))
    return config.feedback * math.sqrt(max(com_height, 0.0) / GRAVITY) * min(phase, 1.0) * saturation * velocity_error


def within_reach(foothold: Array, com: Array, yaw: float, nominal: Array, reach: Array) -> Array:
    """Return ``foothold`` moved into the box that the leg can reach.

    Args:
        foothold, com: in the world, (2,) in [m].
        yaw: heading of the base in [rad].
        nominal: nominal foot position relative to the CoM in the heading frame, (2,) in [m].
        reach: half size of the box in the heading frame, (2,) in [m].
    """
    turn = rotation_2d(yaw)
    offset = np.clip(turn.T @ (foothold - com) - nominal, -reach, reach)
    moved: Array = com + turn @ (nominal + offset)
    return moved
