"""The filter's step from one reading of the inertial unit to the next (Bloesch 2012, III-C and III-D)."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quadlab.configuration import Positive, StrictModel
from quadlab.constants import GRAVITY
from quadlab.estimation.error_state import (
    ACCELEROMETER_BIAS,
    ERROR_SIZE,
    FEET,
    GYRO_BIAS,
    ORIENTATION,
    VELOCITY,
    FilterArrays,
    FilterState,
    rotation_exp,
)
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled, compiled_entry, inlined, source_fingerprint
from quadlab.robots.legs import LEG_COUNT
from quadlab.robots.sensing import SensorReading

_UP = np.array([0.0, 0.0, 1.0])
_GRAVITY = -GRAVITY * _UP
_VELOCITY, _ORIENTATION, _FEET = VELOCITY.start, ORIENTATION.start, FEET.start
_ACCELEROMETER, _GYRO = ACCELEROMETER_BIAS.start, GYRO_BIAS.start
"""First rows of the blocks of the error, as compiled functions take them."""


class ProcessNoiseConfig(StrictModel):
    """Densities of the white noise that the filter reckons with.

    Attributes:
        gyro_radps_per_sqrt_hz: of the gyroscope in [rad/s/sqrt(Hz)].
        accelerometer_mps2_per_sqrt_hz: of the accelerometer in [m/s^2/sqrt(Hz)].
        gyro_bias_radps2_per_sqrt_hz: of the change of the gyroscope's bias in [rad/s^2/sqrt(Hz)].
        accelerometer_bias_mps3_per_sqrt_hz: of the change of the accelerometer's bias in [m/s^3/sqrt(Hz)].
        foot_mps_per_sqrt_hz: of the velocity with which a standing foot slips, in [m/s/sqrt(Hz)].
    """

    gyro_radps_per_sqrt_hz: Positive
    accelerometer_mps2_per_sqrt_hz: Positive
    gyro_bias_radps2_per_sqrt_hz: Positive
    accelerometer_bias_mps3_per_sqrt_hz: Positive
    foot_mps_per_sqrt_hz: Positive


@dataclass(frozen=True)
class Prediction:
    """The outcome of one inertial step.

    Attributes:
        state: one period later.
        dynamics: Jacobian F, (27, 27), of the error after the step by the error before it, at zero error.
    """

    state: FilterState
    dynamics: Array


def predict(
    state: FilterState, reading: SensorReading, foot_spins: Array, period_s: float, foot_radius: float
) -> Prediction:
    """Return the state one period T later and how its error follows from the error before.

        r+ = r + T v + T^2 / 2 (f + g)     v+ = v + T (f + g)     R+ = R exp(T w)     p_i+ = p_i + T Omega_i x rho e_z

    with the angular velocity w and the specific force f without their biases, f turned to world components by the
    mean rotation R_m = R exp(T w / 2). Deviation from Bloesch 2012, whose feet are points: a spherical foot of radius
    rho rolls on the (level) ground with the angular velocity Omega_i of its shank, by about 1 cm in a stance.

    To first order, with B = R_m db_w and u_i = T Omega_i x rho e_z, the errors follow

        dtheta+ = dtheta - T B
        dv+     = dv + T g x dtheta - T R_m db_f - T v+ x B + T^2/2 f x B
        dr+     = dr + T dv + T^2/2 (g x dtheta - R_m db_f) - T r+ x B + T^3/4 f x B
        dp_i+   = dp_i + (T rho e_z x (Omega_i x .) + u_i x .) dtheta + T rho e_z x B - T p_i+ x B

    where terms of T^2 rho are left out.

    Args:
        state: at the start of the period.
        reading: at its end; its rates are means over the period.
        foot_spins: mean angular velocity of each foot relative to the base, in base axes, (4, 3) in [rad/s].
        period_s: T in [s].
        foot_radius: rho in [m].
    """
    arrays, dynamics = _predict(state.arrays, reading.gyro, reading.accelerometer, foot_spins, period_s, foot_radius)
    return Prediction(FilterState(*arrays), dynamics)


def propagate(
    covariance: Array, dynamics: Array, config: ProcessNoiseConfig, standing: BoolArray, period_s: float
) -> Array:
    """Return F P F^T + Q, (27, 27): the covariance after one period.

    The noise of gyroscope and accelerometer enters where their biases do. Q is the first-order discretisation of
    Bloesch 2012, III-D.

    Args:
        covariance: P, (27, 27).
        dynamics: F of the period.
        config: densities.
        standing: feet whose slip counts, (4,).
        period_s: in [s].
    """
    return _propagate(
        covariance,
        dynamics,
        standing,
        period_s,
        config.accelerometer_mps2_per_sqrt_hz,
        config.gyro_radps_per_sqrt_hz,
        config.foot_mps_per_sqrt_hz,
        config.accelerometer_bias_mps3_per_sqrt_hz,
        config.gyro_bias_radps2_per_sqrt_hz,
    )


@inlined
def _cross(vector: Array) -> Array:
    """Return the matrix S, (3, 3), with S b = vector x b."""
    matrix = np.zeros((3, 3))
    matrix[0, 1], matrix[0, 2] = -vector[2], vector[1]
    matrix[1, 0], matrix[1, 2] = vector[2], -vector[0]
    matrix[2, 0], matrix[2, 1] = -vector[1], vector[0]
    return matrix


@compiled
def _error_dynamics(
    period_s: float,
    rotation: Array,
    specific_force: Array,
    foot_spins: Array,
    foot_radius: float,
    position: Array,
    velocity: Array,
    feet: Array,
) -> Array:
    """Return F of ``predict``; arguments in world components, position, velocity and feet after the step."""
    jacobian = np.eye(ERROR_SIZE)
    for axis in range(3):
        jacobian[axis, _VELOCITY + axis] = period_s
    cross_gravity, cross_up = _cross(_GRAVITY), _cross(_UP)
    jacobian[_VELOCITY : _VELOCITY + 3, _ORIENTATION : _ORIENTATION + 3] = period_s * cross_gravity
    jacobian[:3, _ORIENTATION : _ORIENTATION + 3] = 0.5 * period_s**2 * cross_gravity
    turn = -period_s * rotation
    jacobian[_VELOCITY : _VELOCITY + 3, _ACCELEROMETER : _ACCELEROMETER + 3] = turn
    jacobian[:3, _ACCELEROMETER : _ACCELEROMETER + 3] = 0.5 * period_s * turn
    jacobian[_ORIENTATION : _ORIENTATION + 3, _GYRO:] = turn
    lever = 0.5 * period_s * specific_force
    jacobian[_VELOCITY : _VELOCITY + 3, _GYRO:] = _cross(velocity - lever) @ turn
    jacobian[:3, _GYRO:] = _cross(position - 0.5 * period_s * lever) @ turn
    rolled = period_s * foot_radius * cross_up
    for leg in range(LEG_COUNT):
        first = _FEET + 3 * leg
        way = rolled @ _cross(foot_spins[leg])
        way -= _cross(rolled @ foot_spins[leg])
        jacobian[first : first + 3, _ORIENTATION : _ORIENTATION + 3] = way
        jacobian[first : first + 3, _GYRO:] = (_cross(feet[leg]) - foot_radius * cross_up) @ turn
    return jacobian


def _compile_prediction(fingerprint: int) -> Callable[..., tuple[FilterArrays, Array]]:
    @compiled_entry
    def step(
        state: FilterArrays,
        gyro: Array,
        accelerometer: Array,
        foot_spins: Array,
        period_s: float,
        foot_radius: float,
    ) -> tuple[FilterArrays, Array]:
        """Return the arrays of the state after the step and F; see ``predict``."""
        _ = fingerprint  # a closure variable, so that the cached machine code follows a change of any file here
        position, velocity, rotation, feet, accelerometer_bias, gyro_bias = state
        angular_velocity = gyro - gyro_bias
        mean_rotation = rotation @ rotation_exp(0.5 * period_s * angular_velocity)
        force = mean_rotation @ (accelerometer - accelerometer_bias)
        spins, moved_feet = np.empty_like(feet), feet.copy()
        for leg in range(len(feet)):
            spins[leg] = mean_rotation @ (angular_velocity + foot_spins[leg])
            moved_feet[leg, 0] += period_s * foot_radius * spins[leg, 1]  # Omega x rho e_z
            moved_feet[leg, 1] -= period_s * foot_radius * spins[leg, 0]
        acceleration = force + _GRAVITY
        moved = position + period_s * velocity + 0.5 * period_s**2 * acceleration
        later_velocity = velocity + period_s * acceleration
        turned = rotation @ rotation_exp(period_s * angular_velocity)
        dynamics = _error_dynamics(
            period_s, mean_rotation, force, spins, foot_radius, moved, later_velocity, moved_feet
        )
        arrays = (moved, later_velocity, turned, moved_feet, accelerometer_bias.copy(), gyro_bias.copy())
        return arrays, dynamics

    return step


_predict = _compile_prediction(source_fingerprint(Path(__file__).parent))


@compiled_entry
def _propagate(
    covariance: Array,
    dynamics: Array,
    standing: BoolArray,
    period_s: float,
    accelerometer: float,
    gyro: float,
    foot: float,
    accelerometer_bias: float,
    gyro_bias: float,
) -> Array:
    """Return F P F^T + Q of ``propagate`` for the densities of ``ProcessNoiseConfig``."""
    inputs = dynamics[:_ACCELEROMETER, _ACCELEROMETER:].copy()
    inputs[:, :3] *= accelerometer / math.sqrt(period_s)
    inputs[:, 3:] *= gyro / math.sqrt(period_s)
    later = dynamics @ covariance @ dynamics.T
    later[:_ACCELEROMETER, :_ACCELEROMETER] += inputs @ inputs.T
    for axis in range(3):
        for leg in range(LEG_COUNT):
            if standing[leg]:
                later[_FEET + 3 * leg + axis, _FEET + 3 * leg + axis] += period_s * foot**2
        later[_ACCELEROMETER + axis, _ACCELEROMETER + axis] += period_s * accelerometer_bias**2
        later[_GYRO + axis, _GYRO + axis] += period_s * gyro_bias**2
    return later
