"""The heading of the base over time, through the yaw of the waypoints."""

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial, quintic_between
from quadlab.planners.problem import Waypoints


def heading_spline(waypoints: Waypoints) -> PiecewisePolynomial:
    """Return yaw over time in [rad], d = 1: quintic between waypoints, twice continuously differentiable.

    It begins with the given yaw rate, ends at rest and has no angular acceleration at waypoints. Where it begins at
    rest and the yaw of the waypoints is monotone so is the heading: it never swings back before a turn.
    """
    yaw = waypoints.poses[:, 2]
    rates = _monotone_rates(waypoints.times_s, yaw)
    rates[0] = waypoints.yaw_rate
    states = np.stack([yaw, rates, np.zeros_like(yaw)], axis=1)[:, :, None]
    pieces = [
        quintic_between(states[i], states[i + 1], float(duration))
        for i, duration in enumerate(np.diff(waypoints.times_s))
    ]
    return PiecewisePolynomial(waypoints.times_s, np.array(pieces))


def _monotone_rates(times_s: Array, yaw: Array) -> Array:
    """Return yaw rates at the waypoints, (n,) in [rad/s]: harmonic mean of both sides, 0 at ends and turning points."""
    slopes = np.diff(yaw) / np.diff(times_s)
    before, after = slopes[:-1], slopes[1:]
    same_sign = before * after > 0.0
    total = np.where(same_sign, before + after, 1.0)
    rates = np.zeros_like(yaw)
    rates[1:-1] = np.where(same_sign, 2.0 * before * after / total, 0.0)
    return rates
