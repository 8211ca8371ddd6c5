"""Measurements of the legs: exact Jacobian, sound covariance, slipping feet, feet that land."""

from dataclasses import replace

import numpy as np
import pytest
from estimation_cases import any_covariance, any_filter_state, ekf_config
from scipy.linalg import block_diag

from quadlab.estimation.correction import (
    FootInnovations,
    choose_feet,
    correct,
    foot_innovations,
    place_foot,
)
from quadlab.estimation.error_state import ERROR_SIZE, POSITION, FilterState, box_minus, box_plus, foot_block
from quadlab.estimation.leg_kinematics import LegKinematics
from quadlab.geometry.rotations import Array

ALL = np.ones(4, dtype=bool)
CONFIG = ekf_config().leg_measurement


def legs_of(state: FilterState) -> LegKinematics:
    """The legs as they are if ``state`` is true."""
    jacobians = np.random.default_rng(5).normal(scale=0.3, size=(4, 3, 3))
    return LegKinematics((state.feet - state.position) @ state.rotation, jacobians, np.zeros((4, 3)))


def measurement_jacobian(feet: list[int]) -> Array:
    """H of e = H d for the innovations e_i = dp_i - dr of ``feet``."""
    jacobian = np.zeros((len(feet), 3, ERROR_SIZE))
    for row, leg in enumerate(feet):
        jacobian[row, :, POSITION] = -np.eye(3)
        jacobian[row, :, foot_block(leg)] = np.eye(3)
    return jacobian.reshape(-1, ERROR_SIZE)


def innovations(truth: FilterState, estimate: FilterState, covariance: Array) -> FootInnovations:
    return foot_innovations(estimate, covariance, legs_of(truth), CONFIG)


@pytest.mark.parametrize("seed", range(3))
def test_jacobian_is_the_derivative_of_the_innovation(seed: int) -> None:
    state, covariance = any_filter_state(seed), any_covariance(seed)
    size, numeric = 1e-6, np.empty((12, ERROR_SIZE))
    for column in range(ERROR_SIZE):
        error = np.zeros(ERROR_SIZE)
        error[column] = size
        above, below = (innovations(box_plus(state, sign * error), state, covariance) for sign in (1.0, -1.0))
        numeric[:, column] = (above.values - below.values).ravel() / (2.0 * size)
    np.testing.assert_allclose(measurement_jacobian([0, 1, 2, 3]), numeric, atol=1e-8)


def test_noise_of_a_foot_is_that_of_its_joints_and_of_its_model() -> None:
    state, covariance = any_filter_state(0), any_covariance(0)
    found = innovations(state, state, covariance).noise[2]
    jacobian = state.rotation @ legs_of(state).jacobians[2]
    expected = CONFIG.encoder_rad**2 * jacobian @ jacobian.T + CONFIG.kinematics_m**2 * np.eye(3)
    np.testing.assert_allclose(found, expected)


@pytest.mark.parametrize("feet", [[2], [0, 3], [0, 1, 2], [0, 1, 2, 3]])
def test_correction_is_that_of_kalman_in_josephs_form(feet: list[int]) -> None:
    truth, estimate, covariance = any_filter_state(1), any_filter_state(2), any_covariance(1)
    seen, used = innovations(truth, estimate, covariance), np.isin(np.arange(4), feet)
    corrected = correct(estimate, covariance, seen, used)
    jacobian, noise, values = measurement_jacobian(feet), block_diag(*seen.noise[feet]), seen.values[feet].ravel()
    spread = jacobian @ covariance @ jacobian.T + noise
    gain = covariance @ jacobian.T @ np.linalg.inv(spread)
    left = np.eye(ERROR_SIZE) - gain @ jacobian
    np.testing.assert_allclose(corrected.covariance, left @ covariance @ left.T + gain @ noise @ gain.T, atol=1e-12)
    np.testing.assert_allclose(box_minus(corrected.state, estimate), gain @ values, atol=1e-9)
    assert corrected.innovation_squared == pytest.approx(values @ np.linalg.inv(spread) @ values)


def test_correction_brings_the_estimate_nearer_and_the_covariance_stays_sound() -> None:
    truth, covariance = any_filter_state(1), any_covariance(1)
    error = np.linalg.cholesky(covariance) @ np.random.default_rng(2).normal(size=ERROR_SIZE)
    estimate = box_plus(truth, error)
    seen = innovations(truth, estimate, covariance)
    corrected = correct(estimate, covariance, seen, ALL)
    after = innovations(truth, corrected.state, corrected.covariance)
    assert np.abs(after.values).max() < 0.05 * np.abs(seen.values).max()
    np.testing.assert_array_equal(corrected.covariance, corrected.covariance.T)
    assert np.linalg.eigvalsh(corrected.covariance).min() > 0.0
    assert np.linalg.eigvalsh(covariance - corrected.covariance).min() > -1e-15, "a measurement never adds doubt"


def test_innovations_of_a_consistent_filter_are_chi_square_distributed() -> None:
    truth, covariance = any_filter_state(3), any_covariance(3, size=1e-3)
    random, root = np.random.default_rng(4), np.linalg.cholesky(covariance)
    squares = []
    for _ in range(400):
        estimate = box_plus(truth, root @ random.normal(size=ERROR_SIZE))
        seen = innovations(truth, estimate, covariance)
        noise = np.stack([np.linalg.cholesky(block) @ random.normal(size=3) for block in seen.noise])
        squares.append(correct(estimate, covariance, replace(seen, values=seen.values + noise), ALL).innovation_squared)
    assert np.mean(squares) == pytest.approx(12.0, abs=0.75)  # 99.7 % of the mean of 400 draws with 12 degrees


def test_no_foot_no_change() -> None:
    state, covariance = any_filter_state(0), any_covariance(0)
    corrected = correct(state, covariance, innovations(state, state, covariance), ~ALL)
    assert corrected.state is state
    assert corrected.covariance is covariance


def test_distance_tells_a_slipping_foot_from_a_standing_one() -> None:
    state, covariance = any_filter_state(0), any_covariance(0, size=1e-3)
    slipped = state.feet.copy()
    slipped[3] += [0.05, 0.0, 0.0]  # [m]
    distances = innovations(replace(state, feet=slipped), state, covariance).distances
    assert distances[3] > CONFIG.gate
    assert np.all(distances[:3] < 1e-12)


def test_foot_that_lands_has_the_error_of_the_base_and_of_its_measurement() -> None:
    truth, covariance = any_filter_state(1), any_covariance(1)
    estimate = box_plus(truth, 0.01 * np.random.default_rng(2).normal(size=ERROR_SIZE))
    noise = 1e-6 * np.eye(3)
    state, placed = place_foot(estimate, covariance, legs_of(truth), noise, 2)
    error = box_minus(truth, state)
    np.testing.assert_allclose(error[foot_block(2)], error[POSITION], atol=1e-12)
    np.testing.assert_allclose(placed[foot_block(2), foot_block(2)], covariance[POSITION, POSITION] + noise)
    kept = [i for i in range(ERROR_SIZE) if i not in range(*foot_block(2).indices(ERROR_SIZE))]
    np.testing.assert_array_equal(placed[np.ix_(kept, kept)], covariance[np.ix_(kept, kept)])
    np.testing.assert_array_equal(placed, placed.T)


def test_foot_beyond_the_gate_is_refused_and_counted() -> None:
    distances, refusals = np.array([0.0, 2.0 * CONFIG.gate, 0.0, 2.0 * CONFIG.gate]), np.array([3, 4, 0, 5])
    used, counted = choose_feet(distances, np.array([True, True, False, False]), refusals, CONFIG)
    np.testing.assert_array_equal(used, [True, False, False, False])
    np.testing.assert_array_equal(counted, [0, 5, 0, 0])


@pytest.mark.parametrize(("refused", "trusted"), [(CONFIG.blind_ticks - 1, False), (CONFIG.blind_ticks, True)])
def test_all_standing_feet_are_used_once_none_has_fitted_for_long(refused: int, trusted: bool) -> None:
    standing = np.array([True, False, False, True])
    used, _ = choose_feet(np.full(4, 2.0 * CONFIG.gate), standing, np.full(4, refused), CONFIG)
    np.testing.assert_array_equal(used, standing & trusted)
