"""The state of the filter, its error and the box-plus that joins them.

State: base position r, base velocity v, base orientation R (base to world), centres of the four foot spheres p_i, all
in world components, and the biases b_f, b_w of accelerometer and gyroscope in base axes (Bloesch 2012, III-B, in the
same order; there the feet are points).

The error d = (dr, dv, dtheta, dp_1..4, db_f, db_w), (27,), is that of Hartley 2020 (contact-aided invariant EKF):

    R     = exp(dtheta) R^             r   = exp(dtheta) r^ + dr
    v     = exp(dtheta) v^ + dv        p_i = exp(dtheta) p_i^ + dp_i        b = b^ + db

It deviates from Bloesch 2012, where dtheta is in base axes and the position errors are plain differences. There, the
linearisation at changing estimates would make the heading seem observable, which an observability constraint repairs
(its section IV). Here the measurement Jacobian is constant and the unobservable directions (position, rotation about
the vertical) are the same at every estimate, so no constraint is needed.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np

from quadlab.geometry.rotations import Array, rotation_log
from quadlab.jit import compiled, compiled_entry

POSITION = slice(0, 3)
VELOCITY = slice(3, 6)
ORIENTATION = slice(6, 9)
FEET = slice(9, 21)
ACCELEROMETER_BIAS = slice(21, 24)
GYRO_BIAS = slice(24, 27)
ERROR_SIZE = 27
"""Blocks of the error."""

FilterArrays: TypeAlias = tuple[Array, Array, Array, Array, Array, Array]
"""The attributes of ``FilterState`` in their order."""


def foot_block(leg: int) -> slice:
    """Return the block of foot number ``leg``."""
    return slice(FEET.start + 3 * leg, FEET.start + 3 * (leg + 1))


_VELOCITY, _ORIENTATION, _FEET = VELOCITY.start, ORIENTATION.start, FEET.start
_ACCELEROMETER, _GYRO = ACCELEROMETER_BIAS.start, GYRO_BIAS.start


@compiled
def rotation_exp(vector: Array) -> Array:
    """Return exp(vector), (3, 3), of a rotation vector, (3,) in [rad], by Rodrigues' formula."""
    x, y, z = vector[0], vector[1], vector[2]
    squared = x * x + y * y + z * z
    angle = math.sqrt(squared)
    small = squared < 1e-10
    first = 1.0 - squared / 6.0 if small else math.sin(angle) / angle
    second = 0.5 - squared / 24.0 if small else (1.0 - math.cos(angle)) / squared
    rotation = np.empty((3, 3))
    rotation[0, 0], rotation[1, 1], rotation[2, 2] = (
        1.0 - second * (y * y + z * z),
        1.0 - second * (x * x + z * z),
        1.0 - second * (x * x + y * y),
    )
    rotation[0, 1], rotation[1, 0] = second * x * y - first * z, second * x * y + first * z
    rotation[0, 2], rotation[2, 0] = second * x * z + first * y, second * x * z - first * y
    rotation[1, 2], rotation[2, 1] = second * y * z - first * x, second * y * z + first * x
    return rotation


@compiled_entry
def moved_by(
    error: Array, position: Array, velocity: Array, rotation: Array, feet: Array, accelerometer: Array, gyro: Array
) -> FilterArrays:
    """Return the arrays of the state that differs from the given one by ``error``, (27,); see ``box_plus``."""
    turn = rotation_exp(error[_ORIENTATION:_FEET])
    moved_feet = np.empty_like(feet)
    for leg in range(len(feet)):
        first = _FEET + 3 * leg
        moved_feet[leg] = turn @ feet[leg] + error[first : first + 3]
    return (
        turn @ position + error[:_VELOCITY],
        turn @ velocity + error[_VELOCITY:_ORIENTATION],
        turn @ rotation,
        moved_feet,
        accelerometer + error[_ACCELEROMETER:_GYRO],
        gyro + error[_GYRO:],
    )


@dataclass(frozen=True)
class FilterState:
    """What the filter believes.

    Attributes:
        position: r, base origin in world, (3,) in [m].
        velocity: v, of the base origin in world components, (3,) in [m/s].
        rotation: R, base to world, (3, 3).
        feet: p_i, centres of the foot spheres in world, (4, 3) in [m]; of a foot in the air: where it stood last.
        accelerometer_bias: b_f, (3,) in [m/s^2].
        gyro_bias: b_w, (3,) in [rad/s].
    """

    position: Array
    velocity: Array
    rotation: Array
    feet: Array
    accelerometer_bias: Array
    gyro_bias: Array

    @property
    def arrays(self) -> FilterArrays:
        """The attributes in their order, as compiled functions take and return them."""
        return self.position, self.velocity, self.rotation, self.feet, self.accelerometer_bias, self.gyro_bias

    @cached_property
    def feet_from_base(self) -> Array:
        """p_i - r, (4, 3) in [m]."""
        return self.feet - self.position


def box_plus(state: FilterState, error: Array) -> FilterState:
    """Return the state that differs from ``state`` by ``error``, (27,)."""
    return FilterState(*moved_by(error, *state.arrays))


def box_minus(state: FilterState, reference: FilterState) -> Array:
    """Return the error, (27,), with box_plus(reference, error) = state."""
    turn = state.rotation @ reference.rotation.T
    error = np.empty(ERROR_SIZE)
    error[POSITION] = state.position - turn @ reference.position
    error[VELOCITY] = state.velocity - turn @ reference.velocity
    error[ORIENTATION] = rotation_log(turn)
    error[FEET] = (state.feet - reference.feet @ turn.T).ravel()
    error[ACCELEROMETER_BIAS] = state.accelerometer_bias - reference.accelerometer_bias
    error[GYRO_BIAS] = state.gyro_bias - reference.gyro_bias
    return error


def standard_deviations(state: FilterState, covariance: Array) -> Array:
    """Return those of position in [m], velocity in [m/s] and orientation in [rad] along the world's axes, (3, 3).

    They are those of r - r^ = dr - r^ x dtheta and of v - v^ alike, to first order, and not of dr and dv, which grow
    with the distance from the world's origin.
    """
    return _standard_deviations(covariance, state.position, state.velocity)


@compiled_entry
def _standard_deviations(covariance: Array, position: Array, velocity: Array) -> Array:
    turn = covariance[_ORIENTATION:_FEET, _ORIENTATION:_FEET]
    deviations = np.empty((3, 3))
    for axis in range(3):
        after, last = (axis + 1) % 3, (axis + 2) % 3
        for block in range(2):
            arm = position if block == 0 else velocity
            row = 3 * block + axis
            with_last, with_after = covariance[row, _ORIENTATION + last], covariance[row, _ORIENTATION + after]
            variance = covariance[row, row] - 2.0 * (arm[after] * with_last - arm[last] * with_after)
            variance += arm[after] ** 2 * turn[last, last] + arm[last] ** 2 * turn[after, after]
            variance -= 2.0 * arm[after] * arm[last] * turn[after, last]
            deviations[block, axis] = math.sqrt(max(variance, 0.0))
        deviations[2, axis] = math.sqrt(turn[axis, axis])
    return deviations
