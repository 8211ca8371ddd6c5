"""Curves at one time, compiled; apart from the curves, since loading numba takes longer than drawing most figures."""

import math

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry


@compiled_entry
def spline_motion(knots: Array, values: Array, rates: Array, accelerations: Array, time_s: float) -> Array:
    """Return the rows of ``PiecewisePolynomial.motion`` by Horner's scheme, given the coefficients of each row."""
    inside = min(max(time_s, knots[0]), knots[-1])
    piece = np.searchsorted(knots[1:-1], inside, side="right")
    local, size = inside - knots[piece], values.shape[2]
    motion = np.zeros((3, size))
    for row, table in enumerate((values, rates, accelerations)):
        if row > 0 and inside != time_s:
            break
        for power in range(table.shape[1] - 1, -1, -1):
            for axis in range(size):
                motion[row, axis] = motion[row, axis] * local + table[piece, power, axis]
    return motion


@compiled_entry
def lip_motion(knots: Array, coefficients: Array, rate: float, time_s: float) -> Array:
    """Return the rows of ``LipCurve.motion``."""
    inside = min(max(time_s, knots[0]), knots[-1])
    piece = np.searchsorted(knots[1:-1], inside, side="right")
    local, size = inside - knots[piece], coefficients.shape[2]
    even, odd = math.cosh(rate * local), math.sinh(rate * local)
    motion = np.zeros((3, size))
    for axis in range(size):
        offset, slope, p, q = coefficients[piece, :, axis]
        pendulum = even * p + odd * q
        motion[0, axis] = pendulum + (offset + local * slope)
        if inside == time_s:
            motion[1, axis] = rate * (odd * p + even * q) + slope
            motion[2, axis] = rate * rate * pendulum
    return motion
