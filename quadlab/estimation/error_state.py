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

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pinocchio as pin

from quadlab.geometry.rotations import Array, rotation_log
from quadlab.robots.legs import LEG_COUNT

POSITION = slice(0, 3)
VELOCITY = slice(3, 6)
ORIENTATION = slice(6, 9)
FEET = slice(9, 21)
ACCELEROMETER_BIAS = slice(21, 24)
GYRO_BIAS = slice(24, 27)
ERROR_SIZE = 27
"""Blocks of the error."""


def foot_block(leg: int) -> slice:
    """Return the block of foot number ``leg``."""
    return slice(FEET.start + 3 * leg, FEET.start + 3 * (leg + 1))


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

    @cached_property
    def feet_from_base(self) -> Array:
        """p_i - r, (4, 3) in [m]."""
        return self.feet - self.position


def box_plus(state: FilterState, error: Array) -> FilterState:
    """Return the state that differs from ``state`` by ``error``, (27,)."""
    turn = pin.exp3(error[ORIENTATION])
    return FilterState(
        position=turn @ state.position + error[POSITION],
        velocity=turn @ state.velocity + error[VELOCITY],
        rotation=turn @ state.rotation,
        feet=state.feet @ turn.T + error[FEET].reshape(LEG_COUNT, 3),
        accelerometer_bias=state.accelerometer_bias + error[ACCELEROMETER_BIAS],
        gyro_bias=state.gyro_bias + error[GYRO_BIAS],
    )


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
