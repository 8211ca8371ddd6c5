"""How far one orientation is from another, compiled for the controllers that ask in every tick."""

import math

import numpy as np

from quadlab.geometry.rotations import Array, rotation_log
from quadlab.jit import compiled_entry


def rotation_error(rotation: Array, other: Array) -> Array:
    """Return log(rotation other^T), (3,) in [rad]: the turn from ``other`` to ``rotation``, both (3, 3)."""
    error = error_below_half_turn(rotation, other)
    return rotation_log(rotation @ other.T) if math.isnan(error[0]) else error


@compiled_entry
def error_below_half_turn(rotation: Array, other: Array) -> Array:
    """Return the rotation vector; NaN near half a turn, where its antisymmetric part does not know the axis."""
    turn = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                turn[i, j] += rotation[i, k] * other[j, k]
    x, y, z = turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]
    sine = 0.5 * math.sqrt(x * x + y * y + z * z)
    cosine = 0.5 * (turn[0, 0] + turn[1, 1] + turn[2, 2] - 1.0)
    if cosine < 0.0 and sine < 1e-3:
        return np.full(3, np.nan)
    scale = 0.5 * math.atan2(sine, cosine) / sine if sine > 1e-12 else 0.5
    return np.array([scale * x, scale * y, scale * z])
