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
from typing import Self, TypeAlias

import numpy as np

from quadlab.geometry.rotations import Array, rotation_log
from quadlab.jit import compiled, compiled_entry, inlined
from quadlab.robots.legs import LEG_COUNT

POSITION = slice(0, 3)
VELOCITY = slice(3, 6)
ORIENTATION = slice(6, 9)
FEET = slice(9, 21)
ACCELEROMETER_BIAS = slice(21, 24)
GYRO_BIAS = slice(24, 27)
ERROR_SIZE = 27
"""Blocks of the error."""

FilterArrays: TypeAlias = tuple[Array, Array, Array, Array, Array, Array]
"""The attributes of ``FilterState`` but ``values``, in their order."""


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


@inlined
def parts(values: Array) -> FilterArrays:
    """Return views of the attributes of a ``FilterState`` in its values, (33,)."""
    rotation, feet = values[6:15].reshape((3, 3)), values[15:27].reshape((LEG_COUNT, 3))
    return values[:3], values[3:6], rotation, feet, values[27:30], values[30:]


@compiled_entry
def moved_by(error: Array, values: Array) -> Array:
    """Return the values of the state that differs from that of ``values``, (33,), by ``error``; see ``box_plus``."""
    position, velocity, rotation, feet, accelerometer, gyro = parts(values)
    moved = np.empty_like(values)
    later_position, later_velocity, later_rotation, later_feet, later_accelerometer, later_gyro = parts(moved)
    turn = rotation_exp(error[_ORIENTATION:_FEET])
    turned_position, turned_velocity, turned = turn @ position, turn @ velocity, turn @ rotation
    for axis in range(3):
        later_position[axis] = turned_position[axis] + error[axis]
        later_velocity[axis] = turned_velocity[axis] + error[_VELOCITY + axis]
        later_rotation[axis] = turned[axis]
        later_accelerometer[axis] = accelerometer[axis] + error[_ACCELEROMETER + axis]
        later_gyro[axis] = gyro[axis] + error[_GYRO + axis]
    for leg in range(LEG_COUNT):
        first = _FEET + 3 * leg
        later_feet[leg] = turn @ feet[leg] + error[first : first + 3]
    return moved


@dataclass(frozen=True)
class FilterState:
    """What the filter believes; its attributes are views of one array.

    Attributes:
        values: all of it in the order of ``of``, (33,), as compiled functions take and return it.
    """

    values: Array

    @classmethod
    def of(
        cls,
        position: Array,
        velocity: Array,
        rotation: Array,
        feet: Array,
        accelerometer_bias: Array,
        gyro_bias: Array,
    ) -> Self:
        """Return the state with these attributes."""
        return cls(np.concatenate([position, velocity, *rotation, *feet, accelerometer_bias, gyro_bias]))

    @property
    def position(self) -> Array:
        """r, base origin in world, (3,) in [m]."""
        return self.values[:3]

    @property
    def velocity(self) -> Array:
        """v, of the base origin in world components, (3,) in [m/s]."""
        return self.values[3:6]

    @property
    def rotation(self) -> Array:
        """R, base to world, (3, 3)."""
        return self.values[6:15].reshape(3, 3)

    @property
    def feet(self) -> Array:
        """p_i, centres of the foot spheres in world, (4, 3) in [m]; of a foot in the air: where it stood last."""
        return self.values[15:27].reshape(LEG_COUNT, 3)

    @property
    def accelerometer_bias(self) -> Array:
        """b_f, (3,) in [m/s^2]."""
        return self.values[27:30]

    @property
    def gyro_bias(self) -> Array:
        """b_w, (3,) in [rad/s]."""
        return self.values[30:]


def box_plus(state: FilterState, error: Array) -> FilterState:
    """Return the state that differs from ``state`` by ``error``, (27,)."""
    return FilterState(moved_by(error, state.values))


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
