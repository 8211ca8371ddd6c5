"""The filter's step from one reading of the inertial unit to the next (Bloesch 2012, III-C and III-D)."""

import math
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from quadlab.configuration import Positive, StrictModel
from quadlab.estimation.error_state import (
    ACCELEROMETER_BIAS,
    ERROR_SIZE,
    FEET,
    GYRO_BIAS,
    ORIENTATION,
    VELOCITY,
    FilterState,
)
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array, skew
from quadlab.jit import compiled_entry, inlined
from quadlab.planners.problem import GRAVITY
from quadlab.robots.legs import LEG_COUNT
from quadlab.robots.sensing import SensorReading

_UP = np.array([0.0, 0.0, 1.0])
_GRAVITY = -GRAVITY * _UP
_CROSS_UP = skew(_UP)
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
class InertialStep:
    """The motion of the base during one period, by the inertial unit without its biases.

    Attributes:
        period_s: T in [s].
        rotation_change: exp(T w), (3, 3).
        mean_rotation: R exp(T w / 2), base to world in the middle of the period, (3, 3).
        angular_velocity_in_world: w in world components, (3,) in [rad/s].
        specific_force_in_world: f in world components, (3,) in [m/s^2].
        foot_angular_velocities_in_world: of the feet (shanks), (4, 3) in [rad/s].
    """

    period_s: float
    rotation_change: Array
    mean_rotation: Array
    specific_force_in_world: Array
    foot_angular_velocities_in_world: Array


def inertial_step(state: FilterState, reading: SensorReading, foot_spins: Array, period_s: float) -> InertialStep:
    """Return the motion that ``reading`` implies.

    Args:
        state: at the start of the period.
        reading: at its end; its rates are means over the period.
        foot_spins: mean angular velocity of each foot relative to the base, in base axes, (4, 3) in [rad/s].
        period_s: in [s].
    """
    angular_velocity = reading.gyro - state.gyro_bias
    mean_rotation = state.rotation @ pin.exp3(0.5 * period_s * angular_velocity)
    return InertialStep(
        period_s=period_s,
        rotation_change=pin.exp3(period_s * angular_velocity),
        mean_rotation=mean_rotation,
        specific_force_in_world=mean_rotation @ (reading.accelerometer - state.accelerometer_bias),
        foot_angular_velocities_in_world=(angular_velocity + foot_spins) @ mean_rotation.T,
    )


def predict_state(state: FilterState, step: InertialStep, foot_radius: float) -> FilterState:
    """Return the state one period T later.

        r+ = r + T v + T^2 / 2 (f + g)     v+ = v + T (f + g)     R+ = R exp(T w)     p_i+ = p_i + T Omega_i x rho e_z

    with the specific force f in world components. Deviation from Bloesch 2012, whose feet are points: a spherical foot
    of radius rho rolls on the (level) ground with the angular velocity Omega_i of its shank, by about 1 cm in a stance.
    """
    period_s = step.period_s
    acceleration = step.specific_force_in_world + _GRAVITY
    return FilterState(
        position=state.position + period_s * state.velocity + 0.5 * period_s**2 * acceleration,
        velocity=state.velocity + period_s * acceleration,
        rotation=state.rotation @ step.rotation_change,
        feet=state.feet + _rolling(step, foot_radius),
        accelerometer_bias=state.accelerometer_bias,
        gyro_bias=state.gyro_bias,
    )


def error_dynamics(predicted: FilterState, step: InertialStep, foot_radius: float) -> Array:
    """Return the Jacobian F, (27, 27), of the error after the step by the error before it, at zero error.

    With the mean rotation R_m and B = R_m db_w, to first order,

        dtheta+ = dtheta - T B
        dv+     = dv + T g x dtheta - T R_m db_f - T v+ x B + T^2/2 f x B
        dr+     = dr + T dv + T^2/2 (g x dtheta - R_m db_f) - T r+ x B + T^3/4 f x B
        dp_i+   = dp_i + (T rho e_z x (Omega_i x .) + u_i x .) dtheta + T rho e_z x B - T p_i+ x B

    where u_i = T Omega_i x rho e_z; terms of T^2 rho are left out.
    """
    return _error_dynamics(
        step.period_s,
        step.mean_rotation,
        step.specific_force_in_world,
        step.foot_angular_velocities_in_world,
        foot_radius,
        predicted.position,
        predicted.velocity,
        predicted.feet,
    )


def process_noise(dynamics: Array, config: ProcessNoiseConfig, standing: BoolArray, period_s: float) -> Array:
    """Return the covariance Q, (27, 27), of the error that one period adds.

    The noise of gyroscope and accelerometer enters where their biases do. Q is the first-order discretisation of
    Bloesch 2012, III-D.

    Args:
        dynamics: F of the period.
        config: densities.
        standing: feet whose slip counts, (4,).
        period_s: in [s].
    """
    return _process_noise(
        dynamics,
        standing,
        period_s,
        config.accelerometer_mps2_per_sqrt_hz,
        config.gyro_radps_per_sqrt_hz,
        config.foot_mps_per_sqrt_hz,
        config.accelerometer_bias_mps3_per_sqrt_hz,
        config.gyro_bias_radps2_per_sqrt_hz,
    )


def _rolling(step: InertialStep, foot_radius: float) -> Array:
    """Return the way of each sphere's centre, T Omega_i x rho e_z, (4, 3) in [m]."""
    way: Array = -step.period_s * foot_radius * step.foot_angular_velocities_in_world @ _CROSS_UP.T
    return way


@inlined
def _cross(vector: Array) -> Array:
    """Return the matrix S, (3, 3), with S b = vector x b."""
    matrix = np.zeros((3, 3))
    matrix[0, 1], matrix[0, 2] = -vector[2], vector[1]
    matrix[1, 0], matrix[1, 2] = vector[2], -vector[0]
    matrix[2, 0], matrix[2, 1] = -vector[1], vector[0]
    return matrix


@compiled_entry
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
    """Return F of ``error_dynamics``; ``foot_spins`` are the angular velocities Omega_i of the feet."""
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


@compiled_entry
def _process_noise(
    dynamics: Array,
    standing: BoolArray,
    period_s: float,
    accelerometer: float,
    gyro: float,
    foot: float,
    accelerometer_bias: float,
    gyro_bias: float,
) -> Array:
    """Return Q of ``process_noise`` for the densities of ``ProcessNoiseConfig``."""
    inputs = dynamics[:_ACCELEROMETER, _ACCELEROMETER:].copy()
    inputs[:, :3] *= accelerometer / math.sqrt(period_s)
    inputs[:, 3:] *= gyro / math.sqrt(period_s)
    noise = np.zeros((ERROR_SIZE, ERROR_SIZE))
    noise[:_ACCELEROMETER, :_ACCELEROMETER] = inputs @ inputs.T
    for axis in range(3):
        for leg in range(LEG_COUNT):
            if standing[leg]:
                noise[_FEET + 3 * leg + axis, _FEET + 3 * leg + axis] += period_s * foot**2
        noise[_ACCELEROMETER + axis, _ACCELEROMETER + axis] = period_s * accelerometer_bias**2
        noise[_GYRO + axis, _GYRO + axis] = period_s * gyro_bias**2
    return noise
