"""Footholds: corrected in the direction of the fall, within the leg's reach."""

import math
from typing import Any

import numpy as np
import pytest
from controller_cases import tracking_config

from quadlab.controllers.tracking.foothold import balance_correction, within_reach
from quadlab.geometry.rotations import Array, rotation_2d

HEIGHT = 0.47  # [m]
ERROR = np.array([0.2, -0.1])  # [m/s]
COM, YAW, NOMINAL, REACH = np.array([1.0, -2.0]), 0.8, np.array([0.36, 0.2]), (0.25, 0.12)


def capture(velocity_error: Array, height: float, phase: float, **changes: Any) -> Array:
    config = tracking_config(swing=changes).swing
    return balance_correction(config.feedback, config.feedback_speed_limit_mps, velocity_error, height, phase)


def test_correction_is_the_capture_point_at_touch_down() -> None:
    """Stepping sqrt(h / g) v further brings an inverted pendulum with the speed error v to rest."""
    correction = capture(ERROR, HEIGHT, 1.0, feedback=1.0)
    np.testing.assert_allclose(correction, ERROR * math.sqrt(HEIGHT / 9.81))


@pytest.mark.parametrize("phase", [0.0, 0.25, 0.5, 1.0, 1.3])
def test_correction_is_blended_in_over_the_swing(phase: float) -> None:
    full = capture(ERROR, HEIGHT, 1.0)
    np.testing.assert_allclose(capture(ERROR, HEIGHT, phase), min(phase, 1.0) * full)


def test_correction_saturates_and_keeps_its_direction() -> None:
    limit = {"feedback_speed_limit_mps": 0.5}
    at_limit = capture(0.5 * ERROR / np.linalg.norm(ERROR), HEIGHT, 1.0, **limit)
    np.testing.assert_allclose(capture(40.0 * ERROR, HEIGHT, 1.0, **limit), at_limit)
    assert np.linalg.norm(capture(ERROR, HEIGHT, 1.0, **limit)) < np.linalg.norm(at_limit)


def test_no_error_or_no_gain_is_no_correction() -> None:
    np.testing.assert_array_equal(capture(np.zeros(2), HEIGHT, 1.0), 0.0)
    np.testing.assert_array_equal(capture(ERROR, HEIGHT, 1.0, feedback=0.0), 0.0)


def test_robot_that_lies_below_the_ground_plane_gets_no_correction() -> None:
    """A robot on its back has feet above its centre of mass: an outcome to be reported, not an error."""
    np.testing.assert_array_equal(capture(ERROR, -0.1, 1.0), 0.0)


@pytest.mark.parametrize("share", [(0.0, 0.0), (0.9, -0.9), (-1.0, 1.0)])
def test_foothold_within_reach_stays(share: tuple[float, float]) -> None:
    foothold = COM + rotation_2d(YAW) @ (NOMINAL + 0.999999 * np.multiply(REACH, share))
    np.testing.assert_allclose(within_reach(foothold, COM, YAW, NOMINAL, REACH), foothold, atol=1e-12)


@pytest.mark.parametrize("outside", [(1.5, 0.3), (0.2, -2.0), (-3.0, 4.0)])
def test_foothold_out_of_reach_is_moved_to_the_nearest_point_of_the_box(outside: tuple[float, float]) -> None:
    turn = rotation_2d(YAW)
    foothold = COM + turn @ (NOMINAL + np.multiply(REACH, outside))
    nearest = COM + turn @ (NOMINAL + np.multiply(REACH, np.clip(outside, -1.0, 1.0)))
    moved = within_reach(foothold, COM, YAW, NOMINAL, REACH)
    np.testing.assert_allclose(moved, nearest, atol=1e-12)
    np.testing.assert_allclose(within_reach(moved, COM, YAW, NOMINAL, REACH), moved, atol=1e-12)
