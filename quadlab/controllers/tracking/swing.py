"""Foot motion in the air: a quintic from lift-off to foothold, refitted each tick (Gehring 2017, III-B).

A motion is position, velocity and acceleration of a contact point in the world, the rows of (3, 3) in [m], [m/s] and
[m/s^2].
"""

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.jit import compiled


@compiled
def quintic_blend(progress: float) -> tuple[float, float, float]:
    """Return the quintic Hermite blend from 0 to 1 with rest at both ends and its two derivatives by progress."""
    s = min(max(progress, 0.0), 1.0)
    value = s**3 * (10.0 - 15.0 * s + 6.0 * s * s)
    first = 30.0 * s * s * (1.0 - s) ** 2
    second = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)
    return value, first, second


@compiled
def swing_motion(lift_off: Array, foothold: Array, apex: float, phase: float, duration_s: float) -> Array:
    """Return the motion of a swinging foot, (3, 3).

    Horizontally one quintic, vertically two that meet at rest at the apex in the middle of the swing. That a foothold
    moves from tick to tick is no part of velocity and acceleration.

    Args:
        lift_off: measured lift-off point, (3,) in [m].
        foothold: where it shall touch down, (3,) in [m].
        apex: height over the higher end in [m].
        phase: progress of the swing in [0, 1].
        duration_s: of the swing in [s].
    """
    motion = np.empty((3, 3))
    value, first, second = quintic_blend(phase)
    for axis in range(2):
        step = foothold[axis] - lift_off[axis]
        motion[0, axis] = lift_off[axis] + value * step
        motion[1, axis] = first / duration_s * step
        motion[2, axis] = second / duration_s**2 * step
    top = max(lift_off[2], foothold[2]) + apex
    rising = phase < 0.5
    start, end = (lift_off[2], top) if rising else (top, foothold[2])
    value, first, second = quintic_blend(2.0 * phase if rising else 2.0 * phase - 1.0)
    motion[0, 2] = start + value * (end - start)
    motion[1, 2] = first * (end - start) * 2.0 / duration_s
    motion[2, 2] = second * (end - start) * 4.0 / duration_s**2
    return motion


@compiled
def search_motion(start: Array, depth: float, speed: float) -> Array:
    """Return the motion, (3, 3), of a foot that keeps x and y and goes down to find the ground.

    Args:
        start: where the search began, (3,) in [m].
        depth: how far down by now in [m].
        speed: downward speed in [m/s].
    """
    motion = np.zeros((3, 3))
    motion[0] = start
    motion[0, 2] -= depth
    motion[1, 2] = -speed
    return motion
