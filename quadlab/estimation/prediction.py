"""The filter's step from one reading of the inertial unit to the next (Bloesch 2012, III-C and III-D)."""

import math
from collections.abc import Callable
from functools import cached_property
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
    FilterState,
    parts,
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

    @cached_property
    def densities(self) -> tuple[float, float, float, float, float]:
        """Those of gyroscope, accelerometer, their biases and of the feet's slip, as compiled functions take them."""
        return (
            self.gyro_radps_per_sqrt_hz,
            self.accelerometer_mps2_per_sqrt_hz,
            self.gyro_bias_radps2_per_sqrt_hz,
            self.accelerometer_bias_mps3_per_sqrt_hz,
            self.foot_mps_per_sqrt_hz,
        )


def predict(
    state: FilterState,
    covariance: Array,
    reading: SensorReading,
    foot_spins: Array,
    standing: BoolArray,
    config: ProcessNoiseConfig,
    period_s: float,
    foot_radius: float,
) -> tuple[FilterState, Array]:
    """Return state and covariance, (27, 27), one period T later.

        r+ = r + T v + T^2 / 2 (f + g)     v+ = v + T (f + g)     R+ = R exp(T w)     p_i+ = p_i + T Omega_i x rho e_z

    with the angular velocity w and the specific force f without their biases, f turned to world components by the
    mean rotation R_m = R exp(T w / 2). Deviation from Bloesch 2012, whose feet are points: a spherical foot of radius
    rho rolls on the (level) ground with the angular velocity Omega_i of its shank, by about 1 cm in a stance.

    To first order, with B = R_m db_w and u_i = T Omega_i x rho e_z, the errors follow

        dtheta+ = dtheta - T B
        dv+     = dv + T g x dtheta - T R_m db_f - T v+ x B + T^2/2 f x B
        dr+     = dr + T dv + T^2/2 (g x dtheta - R_m db_f) - T r+ x B + T^3/4 f x B
        dp_i+   = dp_i + (T rho e_z x (Omega_i x .) + u_i x .) dtheta + T rho e_z x B - T p_i+ x B

    where terms of T^2 rho are left out. With F of d+ = F d the covariance becomes F P F^T + Q. The noise of gyroscope
    and accelerometer enters Q where their biases do; Q is the first-order discretisation of Bloesch 2012, III-D.

    Args:
        state, covariance: at the start of the period.
        reading: at its end; its rates are means over the period.
        foot_spins: mean angular velocity of each foot relative to the base, in base axes, (4, 3) in [rad/s].
        standing: feet whose slip counts, (4,).
        config: densities of the noise.
        period_s: T in [s].
        foot_radius: rho in [m].
    """
    values, later = _predict(
        state.values,
        covariance,
        (reading.gyro, reading.accelerometer),
        foot_spins,
        standing,
        period_s,
        foot_radius,
        config.densities,
    )
    return FilterState(values), later


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


@compiled
def _grown(
    covariance: Array,
    dynamics: Array,
    standing: BoolArray,
    period_s: float,
    densities: tuple[float, float, float, float, float],
) -> Array:
    """Return F P F^T + Q of ``predict``, (27, 27)."""
    gyro, accelerometer, gyro_bias, accelerometer_bias, foot = densities
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


def _compile_prediction(fingerprint: int) -> Callable[..., tuple[Array, Array]]:
    @compiled_entry
    def step(
        values: Array,
        covariance: Array,
        rates: tuple[Array, Array],
        foot_spins: Array,
        standing: BoolArray,
        period_s: float,
        foot_radius: float,
        densities: tuple[float, float, float, float, float],
    ) -> tuple[Array, Array]:
        """Return values of the state, (33,), and covariance after ``predict``; rates: gyroscope and accelerometer."""
        _ = fingerprint  # a closure variable, so that the cached machine code follows a change of any file here
        gyro, accelerometer = rates
        position, velocity, rotation, feet, accelerometer_bias, gyro_bias = parts(values)
        later = values.copy()
        later_position, later_velocity, later_rotation, later_feet, _, _ = parts(later)
        angular_velocity = gyro - gyro_bias
        mean_rotation = rotation @ rotation_exp(0.5 * period_s * angular_velocity)
        force = mean_rotation @ (accelerometer - accelerometer_bias)
        spins = np.empty_like(feet)
        for leg in range(LEG_COUNT):
            spins[leg] = mean_rotation @ (angular_velocity + foot_spins[leg])
            later_feet[leg, 0] += period_s * foot_radius * spins[leg, 1]  # Omega x rho e_z
            later_feet[leg, 1] -= period_s * foot_radius * spins[leg, 0]
        acceleration = force + _GRAVITY
        turned = rotation @ rotation_exp(period_s * angular_velocity)
        for axis in range(3):
            later_position[axis] = position[axis] + period_s * velocity[axis] + 0.5 * period_s**2 * acceleration[axis]
            later_velocity[axis] = velocity[axis] + period_s * acceleration[axis]
            later_rotation[axis] = turned[axis]
        dynamics = _error_dynamics(
            period_s, mean_rotation, force, spins, foot_radius, later_position, later_velocity, later_feet
        )
        return later, _grown(covariance, dynamics, standing, period_s, densities)

    return step


_predict = _compile_prediction(source_fingerprint(Path(__file__).parent))
