"""Foot motion in the air: a quintic from lift-off to foothold, refitted each tick (Gehring 2017, III-B)."""

from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array


@dataclass(frozen=True)
class FootMotion:
    """Position, velocity and acceleration of a contact point in the world, (3,) each in [m], [m/s], [m/s^2]."""

    position: Array
    velocity: Array
    acceleration: Array

    def at_rate(self, rate: float) -> "FootMotion":
        """Return the same place on the way, passed ``rate`` times as fast."""
        return FootMotion(self.position, rate * self.velocity, rate**2 * self.acceleration)


def quintic_blend(progress: float) -> tuple[float, float, float]:
    """Return the quintic Hermite blend from 0 to 1 with rest at both ends and its two derivatives by progress."""
    s = min(max(progress, 0.0), 1.0)
    value = s**3 * (10.0 - 15.0 * s + 6.0 * s * s)
    first = 30.0 * s * s * (1.0 - s) ** 2
    second = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)
    return value, first, second


def swing_motion(lift_off: Array, foothold: Array, apex: float, phase: float, duration_s: float) -> FootMotion:
    """Return the motion of a swinging foot.

    Horizontally one quintic, vertically two that meet at rest at the apex in the middle of the swing.

    Args:
        lift_off: measured lift-off point, (3,) in [m].
        foothold: where it shall touch down, (3,) in [m].
        apex: height over the higher end in [m].
        phase: progress of the swing in [0, 1].
        duration_s: of the swing in [s].
    """
    along, along_rate, along_rate2 = quintic_blend(phase)
    top = max(lift_off[2], foothold[2]) + apex
    rising = phase < 0.5
    start, end = (lift_off[2], top) if rising else (top, foothold[2])
    up, up_rate, up_rate2 = quintic_blend(2.0 * phase if rising else 2.0 * phase - 1.0)
    step, rise = foothold - lift_off, end - start
    position = lift_off + along * step
    velocity = along_rate / duration_s * step
    acceleration = along_rate2 / duration_s**2 * step
    position[2] = start + up * rise
    velocity[2] = up_rate * rise * 2.0 / duration_s
    acceleration[2] = up_rate2 * rise * 4.0 / duration_s**2
    return FootMotion(position, velocity, acceleration)


def search_motion(start: Array, depth: float, speed: float) -> FootMotion:
    """Return the motion of a foot that keeps x and y and goes down to find the ground.

    Args:
        start: where the search began, (3,) in [m].
        depth: how far down by now in [m].
        speed: downward speed in [m/s].
    """
    down = np.array([0.0, 0.0, 1.0])
    return FootMotion(start - depth * down, -speed * down, np.zeros(3))
