"""The swing of a foot: derivatives, ends and apex; the search for the ground."""

import numpy as np
import pytest

from quadlab.controllers.tracking.swing import search_motion, swing_motion
from quadlab.geometry.rotations import Array

LIFT_OFF = np.array([0.3, 0.2, 0.01])
APEX, DURATION, STEP = 0.09, 0.35, 1e-5
footholds = pytest.mark.parametrize(
    "foothold", [np.array([0.5, 0.15, 0.01]), np.array([0.2, 0.25, 0.11]), np.array([0.45, 0.2, -0.09])], ids=str
)


def at(foothold: np.ndarray, time: float) -> Array:
    return swing_motion(LIFT_OFF, foothold, APEX, time / DURATION, DURATION)


@footholds
@pytest.mark.parametrize("time", [0.03, 0.08, 0.13, 0.17, 0.18, 0.24, 0.29, 0.33])
def test_velocity_and_acceleration_are_derivatives(foothold: np.ndarray, time: float) -> None:
    before, now, after = (at(foothold, time + step) for step in (-STEP, 0.0, STEP))
    np.testing.assert_allclose((after[0] - before[0]) / (2 * STEP), now[1], atol=1e-7)
    np.testing.assert_allclose((after[1] - before[1]) / (2 * STEP), now[2], atol=1e-5)


@footholds
def test_foot_rises_from_lift_off_over_the_apex_to_the_foothold(foothold: np.ndarray) -> None:
    np.testing.assert_allclose(at(foothold, 0.0)[0], LIFT_OFF, atol=1e-12)
    np.testing.assert_allclose(at(foothold, DURATION)[0], foothold, atol=1e-12)
    heights = [at(foothold, time)[0, 2] for time in np.linspace(0.0, DURATION, 201)]
    top = max(LIFT_OFF[2], foothold[2]) + APEX
    assert np.argmax(heights) == 100
    assert max(heights) == pytest.approx(top)
    assert np.all(np.diff(heights[:101]) > 0.0)
    assert np.all(np.diff(heights[100:]) < 0.0)


@footholds
def test_foot_is_at_rest_at_both_ends(foothold: np.ndarray) -> None:
    for time in (0.0, DURATION):
        np.testing.assert_allclose(at(foothold, time)[1], 0.0, atol=1e-12)
        np.testing.assert_allclose(at(foothold, time)[2], 0.0, atol=1e-9)


@footholds
def test_nothing_jumps_at_the_apex(foothold: np.ndarray) -> None:
    """The two vertical pieces meet with equal position, velocity and acceleration."""
    before, after = (at(foothold, 0.5 * DURATION + step) for step in (-1e-9, 1e-9))
    np.testing.assert_allclose(after[0], before[0], atol=1e-7)
    np.testing.assert_allclose(after[1], before[1], atol=1e-6)
    np.testing.assert_allclose(after[2], before[2], atol=1e-4)


def test_foot_waits_over_its_foothold_after_the_swing() -> None:
    foothold = np.array([0.5, 0.15, 0.01])
    late = at(foothold, 1.2 * DURATION)
    np.testing.assert_allclose(late[0], foothold, atol=1e-12)
    np.testing.assert_allclose(late[1], 0.0, atol=1e-12)


def test_inputs_are_left_alone() -> None:
    lift_off, foothold = LIFT_OFF.copy(), np.array([0.5, 0.15, 0.01])
    swing_motion(lift_off, foothold, APEX, 0.3, DURATION)
    np.testing.assert_array_equal(lift_off, LIFT_OFF)
    np.testing.assert_array_equal(foothold, [0.5, 0.15, 0.01])


def test_search_goes_straight_down() -> None:
    motion = search_motion(LIFT_OFF, 0.04, 0.5)
    np.testing.assert_allclose(motion[0], LIFT_OFF - [0.0, 0.0, 0.04])
    np.testing.assert_allclose(motion[1], [0.0, 0.0, -0.5])
    np.testing.assert_allclose(motion[2], 0.0)
