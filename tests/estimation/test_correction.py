"""Measurements of the legs: exact Jacobian, sound covariance, slipping feet, feet that land."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from estimation_cases import any_covariance, any_filter_state, ekf_config
from scipy.linalg import block_diag

from quadlab.estimation.correction import Correction, choose_feet, correct, foot_innovations
from quadlab.estimation.error_state import ERROR_SIZE, POSITION, FilterState, box_minus, box_plus, foot_block
from quadlab.estimation.leg_kinematics import LegKinematics
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array

ALL, NONE = np.ones(4, dtype=bool), np.zeros(4, dtype=bool)
CONFIG = ekf_config().leg_measurement
OPEN = CONFIG.model_copy(update={"gate": 1e9})
"""Believes every foot."""


class Innovations(NamedTuple):
    """What ``foot_innovations`` returns."""

    values: Array
    noise: Array
    distances: Array


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


def innovations(truth: FilterState, estimate: FilterState, covariance: Array) -> Innovations:
    legs, (encoder_variance, kinematics_variance, *_) = legs_of(truth), CONFIG.numbers
    return Innovations(
        *foot_innovations(
            estimate.values, covariance, legs.foot_centers, legs.jacobians, encoder_variance, kinematics_variance
        )
    )


def corrected_by(legs: LegKinematics, estimate: FilterState, covariance: Array, standing: BoolArray) -> Correction:
    """After all ``standing`` feet, whatever they measure."""
    return correct(estimate, covariance, legs, standing, NONE, np.zeros(4, dtype=int), OPEN)


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
    corrected = corrected_by(legs_of(truth), estimate, covariance, used)
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
    corrected = corrected_by(legs_of(truth), estimate, covariance, ALL)
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
        legs, seen = legs_of(truth), innovations(truth, estimate, covariance)
        noise = np.stack([np.linalg.cholesky(block) @ random.normal(size=3) for block in seen.noise])
        measured = replace(legs, foot_centers=legs.foot_centers + noise @ estimate.rotation)
        squares.append(corrected_by(measured, estimate, covariance, ALL).innovation_squared)
    assert np.mean(squares) == pytest.approx(12.0, abs=0.75)  # 99.7 % of the mean of 400 draws with 12 degrees


def test_no_foot_no_change() -> None:
    state, covariance = any_filter_state(0), any_covariance(0)
    corrected = corrected_by(legs_of(any_filter_state(1)), state, covariance, NONE)
    np.testing.assert_array_equal(corrected.state.values, state.values)
    np.testing.assert_array_equal(corrected.covariance, covariance)


def moved_foot(state: FilterState, leg: int, offset_m: float) -> FilterState:
    """``state`` with one foot ``offset_m`` further ahead."""
    error = np.zeros(ERROR_SIZE)
    error[foot_block(leg)] = [offset_m, 0.0, 0.0]
    return box_plus(state, error)


def test_distance_tells_a_slipping_foot_from_a_standing_one() -> None:
    state, covariance = any_filter_state(0), any_covariance(0, size=1e-3)
    distances = innovations(moved_foot(state, 3, 0.05), state, covariance).distances
    assert distances[3] > CONFIG.gate
    assert np.all(distances[:3] < 1e-12)


def test_foot_that_slips_is_refused_until_it_is_placed_anew() -> None:
    state, covariance = any_filter_state(0), any_covariance(0, size=1e-3)
    legs, refusals = legs_of(moved_foot(state, 3, 0.05)), np.zeros(4, dtype=int)
    for tick in range(CONFIG.patience_ticks + 1):
        corrected = correct(state, covariance, legs, ALL, NONE, refusals, CONFIG)
        refusals = corrected.refusals
        np.testing.assert_array_equal(corrected.used, [True, True, True, False])
        np.testing.assert_array_equal(corrected.refused, ~corrected.used)
        patient = tick < CONFIG.patience_ticks
        assert refusals.tolist() == [0, 0, 0, tick + 1 if patient else 0]
        moved = np.linalg.norm(corrected.state.feet[3] - state.feet[3])
        assert moved < 1e-9 if patient else moved == pytest.approx(0.05)


def test_foot_that_lands_has_the_error_of_the_base_and_of_its_measurement() -> None:
    truth, covariance = any_filter_state(1), any_covariance(1)
    estimate = box_plus(truth, 0.01 * np.random.default_rng(2).normal(size=ERROR_SIZE))
    landed = np.arange(4) == 2
    corrected = correct(estimate, covariance, legs_of(truth), landed, landed, np.zeros(4, dtype=int), CONFIG)
    placed, noise = corrected.covariance, innovations(truth, estimate, covariance).noise[2]
    error = box_minus(truth, corrected.state)
    np.testing.assert_array_equal(corrected.used, NONE)
    np.testing.assert_allclose(error[foot_block(2)], error[POSITION], atol=1e-12)
    np.testing.assert_allclose(placed[foot_block(2), foot_block(2)], covariance[POSITION, POSITION] + noise)
    kept = [i for i in range(ERROR_SIZE) if i not in range(*foot_block(2).indices(ERROR_SIZE))]
    np.testing.assert_array_equal(placed[np.ix_(kept, kept)], covariance[np.ix_(kept, kept)])
    np.testing.assert_allclose(placed, placed.T, rtol=1e-14)


def test_foot_beyond_the_gate_is_refused_and_counted() -> None:
    distances, refusals = np.array([0.0, 2.0 * CONFIG.gate, 0.0, 2.0 * CONFIG.gate]), np.array([3, 4, 0, 5])
    used, counted = choose_feet(
        distances, np.array([True, True, False, False]), refusals, CONFIG.gate, CONFIG.blind_ticks
    )
    np.testing.assert_array_equal(used, [True, False, False, False])
    np.testing.assert_array_equal(counted, [0, 5, 0, 0])


@pytest.mark.parametrize(("refused", "trusted"), [(CONFIG.blind_ticks - 1, False), (CONFIG.blind_ticks, True)])
def test_all_standing_feet_are_used_once_none_has_fitted_for_long(refused: int, trusted: bool) -> None:
    standing = np.array([True, False, False, True])
    distances = np.full(4, 2.0 * CONFIG.gate)
    used, _ = choose_feet(distances, standing, np.full(4, refused), CONFIG.gate, CONFIG.blind_ticks)
    np.testing.assert_array_equal(used, standing & trusted)
