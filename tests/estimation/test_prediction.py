"""The inertial step: kinematics of a known motion, exact Jacobian, and what it cannot see."""

import numpy as np
import pytest
from estimation_cases import PERIOD, any_covariance, any_filter_state, ekf_config

from quadlab.constants import GRAVITY
from quadlab.estimation.error_state import (
    ERROR_SIZE,
    FEET,
    ORIENTATION,
    POSITION,
    VELOCITY,
    FilterState,
    box_minus,
    box_plus,
)
from quadlab.estimation.prediction import ProcessNoiseConfig, predict
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array, rotation_zyx
from quadlab.robots.sensing import SensorReading

RADIUS = 0.03  # [m]
KNOWN = np.zeros((ERROR_SIZE, ERROR_SIZE))
ALL = np.ones(4, dtype=bool)
NOISE = ekf_config().process_noise
NO_NOISE = ProcessNoiseConfig.model_validate(dict.fromkeys(ProcessNoiseConfig.model_fields, 1e-100))


def reading(gyro: Array, accelerometer: Array) -> SensorReading:
    return SensorReading(0.0, gyro, accelerometer, np.zeros(12), np.zeros(12), np.zeros(12), np.zeros((4, 3)))


def any_reading(seed: int) -> tuple[SensorReading, Array]:
    generator = np.random.default_rng(1000 + seed)
    return reading(generator.normal(size=3), 10.0 * generator.normal(size=3)), generator.normal(size=(4, 3))


def stepped(state: FilterState, measured: SensorReading, spins: Array) -> FilterState:
    return predict(state, KNOWN, measured, spins, ALL, NOISE, PERIOD, RADIUS)[0]


def grown(
    covariance: Array,
    state: FilterState,
    measured: SensorReading,
    spins: Array,
    standing: BoolArray = ALL,
    noise: ProcessNoiseConfig = NOISE,
) -> Array:
    """The covariance after the step."""
    return predict(state, covariance, measured, spins, standing, noise, PERIOD, RADIUS)[1]


def derivative(state: FilterState, measured: SensorReading, spins: Array) -> Array:
    """F, (27, 27), by differences."""
    predicted = stepped(state, measured, spins)
    size, numeric = 1e-5, np.empty((ERROR_SIZE, ERROR_SIZE))
    for column in range(ERROR_SIZE):
        error = np.zeros(ERROR_SIZE)
        error[column] = size
        above, below = (stepped(box_plus(state, sign * error), measured, spins) for sign in (1.0, -1.0))
        numeric[:, column] = (box_minus(above, predicted) - box_minus(below, predicted)) / (2.0 * size)
    return numeric


@pytest.mark.parametrize("seed", range(5))
def test_covariance_follows_the_derivative_of_the_error(seed: int) -> None:
    state, (measured, spins) = any_filter_state(seed), any_reading(seed)
    jacobian = derivative(state, measured, spins)
    found = grown(np.eye(ERROR_SIZE), state, measured, spins, noise=NO_NOISE)
    np.testing.assert_allclose(found, jacobian @ jacobian.T, atol=1e-6)


def test_resting_unit_stays_at_rest_whatever_its_attitude() -> None:
    rotation = rotation_zyx(0.4, -0.3, 0.2)
    state = FilterState.of(np.zeros(3), np.zeros(3), rotation, np.zeros((4, 3)), np.zeros(3), np.zeros(3))
    later = stepped(state, reading(np.zeros(3), rotation.T @ [0.0, 0.0, GRAVITY]), np.zeros((4, 3)))
    np.testing.assert_allclose(box_minus(later, state), np.zeros(ERROR_SIZE), atol=1e-14)


def test_foot_rolls_by_its_radius_times_the_angle_of_the_shank() -> None:
    state = FilterState.of(np.zeros(3), np.zeros(3), np.eye(3), np.zeros((4, 3)), np.zeros(3), np.zeros(3))
    spins = np.zeros((4, 3))
    spins[1, 1] = 2.0  # [rad/s] about y: the top of the sphere moves along +x
    later = stepped(state, reading(np.zeros(3), np.zeros(3)), spins)
    np.testing.assert_allclose(later.feet[1], [RADIUS * 2.0 * PERIOD, 0.0, 0.0], atol=1e-15)
    np.testing.assert_array_equal(later.feet[[0, 2, 3]], 0.0)


@pytest.mark.parametrize("seed", range(3))
def test_position_and_heading_are_unobservable_at_every_estimate(seed: int) -> None:
    """What shifts or turns base and feet together stays what it was and is not felt by the legs."""
    state, (measured, spins) = any_filter_state(seed), any_reading(seed)
    hidden = np.zeros((ERROR_SIZE, 4))
    hidden[POSITION, :3] = np.eye(3)
    hidden[FEET, :3] = np.tile(np.eye(3), (4, 1))
    hidden[ORIENTATION, 3] = [0.0, 0.0, 1.0]
    found = grown(hidden @ hidden.T, state, measured, spins, noise=NO_NOISE)
    np.testing.assert_allclose(found, hidden @ hidden.T, atol=1e-14)


def test_noise_of_a_period_is_symmetric_and_grows_velocity_and_standing_feet() -> None:
    state, (measured, spins) = any_filter_state(0), any_reading(0)
    noise, in_air = (grown(KNOWN, state, measured, spins, np.array([flag] + [False] * 3)) for flag in (True, False))
    np.testing.assert_array_equal(noise, noise.T)
    assert np.linalg.eigvalsh(noise).min() > -1e-20
    least = PERIOD * NOISE.accelerometer_mps2_per_sqrt_hz**2
    assert np.all(np.diag(noise)[VELOCITY] >= 0.999 * least)
    slip = PERIOD * NOISE.foot_mps_per_sqrt_hz**2
    np.testing.assert_allclose(np.diag(noise - in_air)[FEET], [slip] * 3 + [0.0] * 9, atol=1e-16)


def test_noise_adds_to_what_the_dynamics_make_of_the_covariance() -> None:
    state, (measured, spins), covariance = any_filter_state(1), any_reading(1), any_covariance(1)
    noise, without, both = (
        grown(before, state, measured, spins, noise=config)
        for before, config in ((KNOWN, NOISE), (covariance, NO_NOISE), (covariance, NOISE))
    )
    np.testing.assert_allclose(both, without + noise, atol=1e-15)
