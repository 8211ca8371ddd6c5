"""The filter on recorded motions: exact without noise, convergent at rest, honest about its errors, repeatable."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from estimation_cases import PERIOD, Replay, Tick, ekf_config, recorded_motion, replay
from scipy.stats import chi2

from quadlab.estimation.error_state import ORIENTATION, VELOCITY
from quadlab.geometry.rotations import Array, euler_zyx, rotation_log, skew

TROT = ("gait=trot", "duration_s=5")
HYQ_TROT = ("gait=trot", "duration_s=4", "robot=hyq")
WALK = ("gait=walk", "duration_s=7")
STAND = ("gait=stand", "command=in_place", "duration_s=4")
SEEDS = range(8)
SETTLED = round(2.0 / PERIOD)  # ticks


UNCERTAIN_START = {"initial.tilt_rad": 0.01, "initial.velocity_mps": 0.05}
"""A filter that is switched on as the motion begins."""


@lru_cache
def shipped(motion: tuple[str, ...], seed: int) -> Replay:
    return replay(recorded_motion(*motion), ekf_config(), seed)


def position_errors(run: Replay) -> Array:
    pairs = zip(run.estimates, run.truth, strict=True)
    return np.array([e.state.position_base_in_world - t.position_base_in_world for e, t in pairs])


def velocity_errors(run: Replay) -> Array:
    """In base axes: heading does not enter."""
    pairs = [(e.state, t) for e, t in zip(run.estimates, run.truth, strict=True)]
    return np.array(
        [
            e.rotation_base_to_world.T @ e.linear_velocity_base_in_world
            - t.rotation_base_to_world.T @ t.linear_velocity_base_in_world
            for e, t in pairs
        ]
    )


def euler_errors(run: Replay) -> Array:
    """Yaw, pitch, roll in [rad]."""
    pairs = [
        (e.state.rotation_base_to_world, t.rotation_base_to_world)
        for e, t in zip(run.estimates, run.truth, strict=True)
    ]
    return np.array([np.subtract(euler_zyx(estimated), euler_zyx(true)) for estimated, true in pairs])


def observable_error(run: Replay, tick: int) -> tuple[Array, Array]:
    """Error of velocity, roll and pitch as the filter defines it, (5,), and its covariance."""
    state, truth = run.states[tick], run.truth[tick]
    turn = truth.rotation_base_to_world @ state.rotation.T
    velocity = truth.linear_velocity_base_in_world - turn @ state.velocity
    rows = [*range(9)[VELOCITY], *range(9)[ORIENTATION][:2]]
    return np.append(velocity, rotation_log(turn)[:2]), run.covariances[tick][np.ix_(rows, rows)]


@pytest.mark.parametrize(("motion", "robot"), [(TROT, "anymal_b"), (WALK, "anymal_b"), (HYQ_TROT, "hyq")])
def test_perfect_sensors_give_the_truth(motion: tuple[str, ...], robot: str) -> None:
    run = replay(recorded_motion(*motion), ekf_config(perfect=True), seed=0, robot=robot)
    assert np.abs(velocity_errors(run)).max() < 2e-3  # [m/s]
    assert np.abs(np.degrees(euler_errors(run))).max() < 0.01
    assert np.abs(position_errors(run)[:, :2]).max() < 2e-3  # [m]
    assert np.abs(position_errors(run)[:, 2]).max() < 5e-3  # [m] the ground gives way under a landing foot


def test_rolling_of_the_feet_matters() -> None:
    """With point feet, as in Bloesch 2012, the base seems to travel too little."""
    ticks, config = recorded_motion(*TROT), ekf_config(perfect=True)
    spheres, points = (replay(ticks, config, 0, point_feet=flag) for flag in (False, True))
    travelled = float(spheres.truth[-1].position_base_in_world[0])
    assert abs(position_errors(spheres)[-1, 0]) < 2e-3 * travelled
    assert position_errors(points)[-1, 0] < -0.02 * travelled


def test_standing_still_finds_what_can_be_found() -> None:
    """Velocity, gyroscope bias and vertical accelerometer bias; tilt and horizontal bias hide each other."""
    for seed in range(3):
        run = replay(recorded_motion(*STAND), ekf_config(UNCERTAIN_START), seed)
        last = run.states[-1]
        assert np.abs(velocity_errors(run)[-400:]).max() < 3e-3  # [m/s]
        assert np.abs(last.gyro_bias - run.sensors.gyro_bias)[:2].max() < 3e-4  # [rad/s], from 3.5e-3
        assert abs(last.accelerometer_bias[2] - run.sensors.accelerometer_bias[2]) < 3e-3  # [m/s^2], from 0.03
        start, end = (np.sqrt(np.diag(run.covariances[tick])) for tick in (0, -1))
        assert end[ORIENTATION][:2].max() < 0.5 * start[ORIENTATION][:2].max()
        apparent_tilt = run.sensors.accelerometer_bias[:2] / 9.81
        assert np.abs(euler_errors(run)[-1, 1:]).max() < 1.5 * np.abs(apparent_tilt).max() + 1e-3


@pytest.mark.parametrize("seed", range(3))
def test_trot_with_real_sensors(seed: int) -> None:
    run = shipped(TROT, seed)
    assert np.sqrt((velocity_errors(run)[SETTLED:] ** 2).sum(axis=1).mean()) < 3e-3  # [m/s]
    assert np.sqrt((np.degrees(euler_errors(run)[SETTLED:, 1:]) ** 2).sum(axis=1).mean()) < 0.5
    assert np.linalg.norm(position_errors(run)[-1]) < 0.03  # [m] after 1 m


def test_filter_that_thinks_too_well_of_its_encoders_does_not_run_away() -> None:
    """Most measurements fail the gate; without the rule for all feet at once nothing would bound the velocity."""
    run = replay(recorded_motion(*TROT), ekf_config({"sensors.joints.position_noise_rad": 1e-3}), seed=0)
    assert np.abs(velocity_errors(run)[SETTLED:]).max() < 0.15  # [m/s]
    assert np.linalg.norm(position_errors(run)[-1]) < 0.1  # [m]


def test_errors_are_as_large_as_the_filter_says() -> None:
    """Normalised error squared of the observable states (velocity, roll, pitch), mean over independent seeds.

    The mean over ``SEEDS`` times 5 degrees of freedom is chi-square distributed for a consistent filter. The filter
    reckons with more noise of the legs than there is, so that it errs on the safe side of the lower bound; the upper
    bound, beyond which it would be overconfident, holds at every instant that is looked at.
    """
    _, upper = chi2.interval(0.95, 5 * len(SEEDS)) / np.array(len(SEEDS))
    runs = [shipped(TROT, seed) for seed in SEEDS]
    means = []
    for tick in range(SETTLED, len(runs[0].truth), round(0.5 / PERIOD)):
        squares = []
        for run in runs:
            error, covariance = observable_error(run, tick)
            squares.append(error @ np.linalg.solve(covariance, error))
        means.append(np.mean(squares))
    assert np.mean(means) > 2.0, "far too pessimistic"
    assert np.mean(means) < upper
    assert np.max(means) < 1.5 * upper


def test_tilt_alone_is_consistent_on_both_sides() -> None:
    lower, upper = chi2.interval(0.95, 2 * len(SEEDS)) / np.array(len(SEEDS))
    squares = []
    for seed in SEEDS:
        error, covariance = observable_error(shipped(TROT, seed), -1)
        squares.append(error[3:] @ np.linalg.solve(covariance[3:, 3:], error[3:]))
    assert lower < np.mean(squares) < upper


def test_heading_and_position_are_doubted_more_and_more() -> None:
    run = shipped(TROT, 0)
    stds = [estimate.report for estimate in run.estimates[SETTLED:] if estimate.report is not None]
    assert stds[-1].orientation_std[2] > stds[0].orientation_std[2]
    assert np.all(stds[-1].position_std > stds[0].position_std)


@pytest.mark.parametrize("sensing", ["forces", "torques"])
def test_contact_is_felt_soon_and_never_in_the_air(sensing: str) -> None:
    run = replay(recorded_motion(*TROT), ekf_config({"contact_sensing": sensing}), seed=0)
    felt = np.array([estimate.report.contacts for estimate in run.estimates if estimate.report is not None])
    loaded = np.array([truth.foot_forces_in_world[:, 2] > 1.0 for truth in run.truth])
    settling = round(0.01 / PERIOD)
    for leg in range(4):
        landings = np.flatnonzero(~loaded[:-1, leg] & loaded[1:, leg]) + 1
        lasting = [tick for tick in landings if loaded[tick : tick + 40, leg].all()]
        delays = [np.argmax(felt[tick : tick + 40, leg]) * PERIOD for tick in lasting]
        assert len(delays) >= 5
        assert max(delays) <= 0.03  # [s]
        assert min(delays) >= 0.0
        long_in_air = ~np.array([loaded[max(0, k - settling) : k + 1, leg].any() for k in range(len(loaded))])
        assert not (felt[:, leg] & long_in_air).any()


def _numbers(run: Replay) -> bytes:
    return b"".join(
        estimate.state.quat_wxyz.tobytes() + estimate.state.position_base_in_world.tobytes()
        for estimate in run.estimates
    )


def test_equal_seeds_give_equal_estimates_to_the_last_bit() -> None:
    ticks: tuple[Tick, ...] = recorded_motion(*STAND)[:400]
    first, again, other = (replay(ticks, ekf_config(), seed) for seed in (7, 7, 8))
    assert _numbers(first) == _numbers(again)
    assert _numbers(first) != _numbers(other)


def test_covariance_stays_symmetric_and_positive() -> None:
    for covariance in shipped(TROT, 0).covariances[::200]:
        np.testing.assert_allclose(covariance, covariance.T, atol=1e-12)
        assert np.linalg.eigvalsh(covariance).min() > 0.0


def _shifted(tick: Tick, offset: Array) -> Tick:
    state, imu, command = tick
    return replace(state, position_base_in_world=state.position_base_in_world + offset), imu, command


def test_estimate_does_not_depend_on_where_the_world_has_its_origin() -> None:
    offset = np.array([30.0, -20.0, 0.0])  # [m]
    here, there = (
        replay(tuple(_shifted(tick, shift) for tick in recorded_motion(*TROT)), ekf_config(), seed=3)
        for shift in (np.zeros(3), offset)
    )
    second_order = 0.5 * 0.003**2 * float(np.linalg.norm(offset))  # [m] of turning by the initial tilt
    np.testing.assert_allclose(position_errors(there), position_errors(here), atol=second_order)
    for near, far in zip(here.estimates, there.estimates, strict=True):
        assert near.report is not None and far.report is not None
        np.testing.assert_allclose(far.report.position_std, near.report.position_std, rtol=1e-2, atol=1e-6)
        np.testing.assert_allclose(far.report.velocity_std, near.report.velocity_std, rtol=1e-2)


def test_position_is_as_uncertain_as_the_filter_says() -> None:
    """Normalised error squared of the position, mean over independent seeds."""
    lower, upper = chi2.interval(0.99, 3 * len(SEEDS)) / np.array(len(SEEDS))
    squares = []
    for seed in SEEDS:
        run = shipped(TROT, seed)
        state, covariance = run.states[-1], run.covariances[-1][:9, :9]
        to_position = np.hstack([np.eye(3), np.zeros((3, 3)), -skew(state.position)])
        error = run.truth[-1].position_base_in_world - state.position
        squares.append(error @ np.linalg.solve(to_position @ covariance @ to_position.T, error))
        report = run.estimates[-1].report
        assert report is not None
        stds = np.sqrt(np.diag(to_position @ covariance @ to_position.T))
        np.testing.assert_allclose(report.position_std, stds, rtol=1e-9)
    assert lower < np.mean(squares) < upper
