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
    POSITION,
    VELOCITY,
    FilterState,
)
from quadlab.geometry.rotations import Array, skew
from quadlab.planners.problem import GRAVITY
from quadlab.robots.sensing import SensorReading

_UP = np.array([0.0, 0.0, 1.0])
_GRAVITY = -GRAVITY * _UP
_CROSS_GRAVITY, _CROSS_UP = skew(_GRAVITY), skew(_UP)
_EYE = np.eye(3)
_CROSS_BASIS = np.stack([skew(axis).ravel() for axis in _EYE])


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
    period_s, rotation = step.period_s, step.mean_rotation
    jacobian = np.eye(ERROR_SIZE)
    jacobian[POSITION, VELOCITY] = period_s * _EYE
    jacobian[VELOCITY, ORIENTATION] = period_s * _CROSS_GRAVITY
    jacobian[POSITION, ORIENTATION] = 0.5 * period_s**2 * _CROSS_GRAVITY
    jacobian[VELOCITY, ACCELEROMETER_BIAS] = -period_s * rotation
    jacobian[POSITION, ACCELEROMETER_BIAS] = -0.5 * period_s**2 * rotation
    turn = -period_s * rotation
    jacobian[ORIENTATION, GYRO_BIAS] = turn
    lever = 0.5 * period_s * step.specific_force_in_world
    levers = _cross_matrices(np.stack([predicted.velocity - lever, predicted.position - 0.5 * period_s * lever]))
    jacobian[VELOCITY, GYRO_BIAS] = levers[0] @ turn
    jacobian[POSITION, GYRO_BIAS] = levers[1] @ turn
    _fill_feet(jacobian, predicted, step, foot_radius, turn)
    return jacobian


def process_noise(dynamics: Array, config: ProcessNoiseConfig, standing: Array, period_s: float) -> Array:
    """Return the covariance Q, (27, 27), of the error that one period adds.

    The noise of gyroscope and accelerometer enters where their biases do. Q is the first-order discretisation of
    Bloesch 2012, III-D.

    Args:
        dynamics: F of the period.
        config: densities.
        standing: feet whose slip counts, (4,).
        period_s: in [s].
    """
    inputs = dynamics[:, ACCELEROMETER_BIAS.start : GYRO_BIAS.stop].copy()
    inputs[ACCELEROMETER_BIAS.start :] = 0.0
    root_s = math.sqrt(period_s)
    inputs[:, :3] *= config.accelerometer_mps2_per_sqrt_hz / root_s
    inputs[:, 3:] *= config.gyro_radps_per_sqrt_hz / root_s
    noise: Array = inputs @ inputs.T
    diagonal = np.einsum("ii->i", noise)
    diagonal[FEET] += np.repeat(period_s * config.foot_mps_per_sqrt_hz**2 * standing, 3)
    diagonal[ACCELEROMETER_BIAS] += period_s * config.accelerometer_bias_mps3_per_sqrt_hz**2
    diagonal[GYRO_BIAS] += period_s * config.gyro_bias_radps2_per_sqrt_hz**2
    return noise


def _rolling(step: InertialStep, foot_radius: float) -> Array:
    """Return the way of each sphere's centre, T Omega_i x rho e_z, (4, 3) in [m]."""
    way: Array = -step.period_s * foot_radius * step.foot_angular_velocities_in_world @ _CROSS_UP.T
    return way


def _fill_feet(jacobian: Array, predicted: FilterState, step: InertialStep, foot_radius: float, turn: Array) -> None:
    rolled = step.period_s * foot_radius * _CROSS_UP
    ways = _cross_matrices(_rolling(step, foot_radius))
    spins = _cross_matrices(step.foot_angular_velocities_in_world)
    jacobian[FEET, ORIENTATION] = (rolled @ spins + ways).reshape(-1, 3)
    jacobian[FEET, GYRO_BIAS] = ((_cross_matrices(predicted.feet) - foot_radius * _CROSS_UP) @ turn).reshape(-1, 3)


def _cross_matrices(vectors: Array) -> Array:
    """Return the matrices S_i with S_i b = v_i x b for ``vectors``, (n, 3), as (n, 3, 3)."""
    return (vectors @ _CROSS_BASIS).reshape(-1, 3, 3)
