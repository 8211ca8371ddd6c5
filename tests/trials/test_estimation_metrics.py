"""Errors of an estimate: what legs and inertial unit cannot observe is told apart from what they can."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tick_cases import HEIGHT_M, exact_telemetry, still_state, turned

from quadlab.estimation.estimate import Estimate, FilterReport
from quadlab.geometry.rotations import rotation_z
from quadlab.robots.kinematics import MotionPoints
from quadlab.robots.state import RobotState
from quadlab.trials.estimation_metrics import EstimationMetrics
from quadlab.trials.observer import as_it_happened

VELOCITY = np.array([0.3, -0.1, 0.05])  # [m/s]
NONE, FEET = np.zeros(3), np.zeros(4, dtype=bool)


def report(squared: float = 0.0, size: int = 0, outliers: int = 0) -> FilterReport:
    return FilterReport(NONE, NONE, FEET, FEET, NONE, NONE, NONE, squared, size, outliers, 100.0)


def summary(*ticks: tuple[RobotState, RobotState, FilterReport], **telemetry: Any) -> dict[str, Any]:
    """Metrics of ticks of (true state, believed state, report)."""
    metrics = EstimationMetrics()
    for true, believed, told in ticks:
        metrics.add(true, Estimate(believed, told), exact_telemetry(**telemetry))
    return metrics.summary()


def test_heading_and_position_that_drift_are_no_error_of_what_can_be_observed() -> None:
    """A robot that is believed elsewhere and turned about the vertical moves in the same way as seen from itself."""
    drift = np.array([0.03, 0.0, -0.04])
    true = still_state(linear_velocity_base_in_world=VELOCITY, quat_wxyz=turned(0.5, 0.1, -0.05))
    believed = replace(
        true,
        position_base_in_world=true.position_base_in_world + drift,
        linear_velocity_base_in_world=rotation_z(0.3) @ VELOCITY,
        quat_wxyz=turned(0.8, 0.1, -0.05),
    )
    found = summary((true, believed, report()))
    assert found["estimate_position_drift_mm"] == pytest.approx(50.0)
    assert found["estimate_yaw_drift_deg"] == pytest.approx(math.degrees(0.3))
    for name in ("estimate_velocity_rms_mps", "estimate_roll_pitch_rms_deg", "estimate_roll_pitch_max_deg"):
        assert found[name] == pytest.approx(0.0, abs=1e-9), name


def test_tilt_and_velocity_are_told_by_tick() -> None:
    true = still_state(quat_wxyz=turned(2.0))
    tilted = replace(true, quat_wxyz=turned(2.0, 0.01), linear_velocity_base_in_world=np.array([0.0, 0.0, 0.02]))
    found = summary((true, true, report()), (true, tilted, report()))
    assert found["estimate_roll_pitch_max_deg"] == pytest.approx(math.degrees(0.01))
    assert found["estimate_roll_pitch_rms_deg"] == pytest.approx(math.degrees(0.01) / math.sqrt(2.0))
    assert found["estimate_velocity_rms_mps"] == pytest.approx(0.02 / math.sqrt(2.0))
    assert found["estimate_position_drift_mm"] == 0.0


def test_innovations_are_told_per_degree_of_freedom_and_refusals_so_far() -> None:
    still = still_state()
    found = summary(
        (still, still, report(9.0, 6, 1)), (still, still, report(0.0, 0, 4)), (still, still, report(9.0, 12, 4))
    )
    assert found["estimate_innovation_ratio"] == pytest.approx(1.0)
    assert found["estimate_outliers"] == 4
    assert summary((still, still, report()))["estimate_innovation_ratio"] == 0.0


def test_what_the_controller_believed_is_judged_by_its_own_reference() -> None:
    believed = still_state(position_base_in_world=np.array([0.0, 0.0, HEIGHT_M + 0.01]))
    found = summary((still_state(), believed, report()), com_position=np.array([0.003, 0.004, 0.1]))
    assert found["com_error_believed_max_mm"] == found["com_error_believed_rms_mm"] == pytest.approx(5.0)
    assert found["base_height_believed_rms_mm"] == pytest.approx(10.0)


def test_truth_has_no_error_of_an_estimate() -> None:
    metrics = EstimationMetrics()
    metrics.add(still_state(), Estimate(still_state()), exact_telemetry())
    assert metrics.summary() == {}


def test_ground_lies_as_far_below_the_robot_as_it_is_believed_to() -> None:
    """The filter has drifted up by 5 cm, and with it the ground that it has felt; all else is the true motion."""
    points = MotionPoints(
        *np.random.default_rng(0).normal(size=(2, 3)), *np.random.default_rng(1).normal(size=(2, 4, 3))
    )
    true, believed = still_state(), still_state(position_base_in_world=np.array([0.2, 0.1, HEIGHT_M + 0.05]))
    told = exact_telemetry(terrain_plane=np.array([0.05, 0.1, -0.2]), com_position=np.ones(3))
    happened = as_it_happened(told, Estimate(believed, report()), true, points)
    np.testing.assert_allclose(happened.terrain_plane, [0.0, 0.1, -0.2], atol=1e-12)
    np.testing.assert_array_equal(happened.com_position, points.com_position)
    np.testing.assert_array_equal(happened.com_velocity, points.com_velocity)
    np.testing.assert_array_equal(happened.foot_positions, points.foot_positions)
    np.testing.assert_array_equal(happened.foot_contact_velocities, points.foot_contact_velocities)
    np.testing.assert_array_equal(happened.com_position_reference, told.com_position_reference)
