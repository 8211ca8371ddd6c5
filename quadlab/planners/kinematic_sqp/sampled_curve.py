"""A curve through samples whose accelerations at the samples are exactly the finite differences of the program."""

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial, quintic_between

_FADE_PIECES = 4  # over which a shift at a change of the sample period fades
_SAME_PERIOD = 1e-9  # relative


def sampled_curve(times_s: Array, points: Array) -> PiecewisePolynomial:
    """Return the curve of samples x_i: a uniform cubic B-spline with the samples as control points.

    Its acceleration runs linearly between a_i = (x_{i+1} - 2 x_i + x_{i-1}) / h^2, with which the program computes
    the CoP, Eq. (7); its position at a sample is x_i + h^2 a_i / 6. Splines through the samples have other
    accelerations and throw the CoP of a trot centimetres out. At both ends the acceleration is 0: the curve begins
    in the first sample with the velocity of the first interval. Where the sample period changes from h to h',
    velocity and acceleration stay continuous and the shift (h^2 - h'^2) a_i / 6 fades over the longer intervals.

    Args:
        times_s: (n,) increasing in [s], n >= 3.
        points: (n, d).
    """
    periods = np.diff(times_s)[:, None]
    differences = np.diff(points, axis=0) / periods
    acceleration = np.zeros_like(points)
    acceleration[1:-1] = 2.0 * np.diff(differences, axis=0) / (periods[:-1] + periods[1:])
    before, after = acceleration[:-1], acceleration[1:]
    coefficients = np.zeros((len(periods), 6, points.shape[1]))
    coefficients[:, 0] = points[:-1] + periods**2 * before / 6.0
    coefficients[:, 1] = differences - periods * before / 2.0
    coefficients[:, 2] = before / 2.0
    coefficients[:, 3] = (after - before) / (6.0 * periods)
    _fade_shifts(coefficients, periods[:, 0], acceleration)
    return PiecewisePolynomial(times_s, coefficients)


def _fade_shifts(coefficients: Array, periods: Array, acceleration: Array) -> None:
    """Make the position continuous where the sample period changes, in place."""
    changes = np.flatnonzero(np.abs(np.diff(periods)) > _SAME_PERIOD * periods[:-1]) + 1
    for knot in changes:
        before, after = float(periods[knot - 1]), float(periods[knot])
        shift = (before**2 - after**2) * acceleration[knot] / 6.0  # of the end before over the beginning after
        longer_before = before > after
        neighbours = periods[:knot][::-1] if longer_before else periods[knot:]
        equal = np.abs(neighbours - neighbours[0]) <= _SAME_PERIOD * neighbours[0]
        count = min(_FADE_PIECES, int(np.argmin(np.append(equal, False))))
        fade = _fade(float(neighbours[0]), count, shift)
        if longer_before:
            coefficients[knot - count : knot] -= fade
        else:
            coefficients[knot : knot + count] += _falling(fade, shift)


def _falling(fade: Array, shift: Array) -> Array:
    """Return the rise ``fade`` from 0 to ``shift`` as a fall from ``shift`` to 0: shift minus the rise, (n, 6, d)."""
    fall = -fade
    fall[:, 0] += shift
    return fall


def _fade(period_s: float, count: int, shift: Array) -> Array:
    """Return a quintic rise from 0 to ``shift``, at rest at both ends, cut into ``count`` pieces, (count, 6, d)."""
    duration = period_s * count
    rest = np.zeros((2, len(shift)))
    whole = quintic_between(np.vstack([[0.0 * shift], rest]), np.vstack([[shift], rest]), duration)
    curve = PiecewisePolynomial(np.array([0.0, duration]), whole[None])
    states = [np.array([curve(period_s * k, order) for order in range(3)]) for k in range(count + 1)]
    states[-1] = np.vstack([[shift], rest])
    return np.array([quintic_between(states[k], states[k + 1], period_s) for k in range(count)])
