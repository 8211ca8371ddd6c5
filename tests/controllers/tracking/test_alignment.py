"""The alignment of the plan with a displaced robot: exact for rigid motions, smooth at new footholds."""

import math

import numpy as np
import pytest

from quadlab.controllers.tracking.alignment import (
    PlanarPose,
    SmoothedAlignment,
    base_alignment,
    feet_alignment,
    identity_alignment,
)
from quadlab.geometry.rotations import Array, rotation_2d, wrap_angle

PLANNED = np.array([[0.36, 0.20], [0.30, -0.22], [-0.35, 0.18], [-0.38, -0.2]])
MOTIONS = [(0.0, (0.0, 0.0)), (0.3, (0.5, -0.2)), (-2.0, (0.0, 1.0)), (3.1, (-3.0, 4.0))]
motions = pytest.mark.parametrize(("yaw", "shift"), MOTIONS)
PERIOD, TIME_CONSTANT = 0.0025, 0.1  # [s]
TORSO = np.array([0.9, 0.1])


def moved(points: Array, yaw: float, shift: tuple[float, float]) -> Array:
    return np.asarray(points @ rotation_2d(yaw).T + np.array(shift))


@motions
def test_planned_feet_are_laid_on_the_feet_of_a_rigidly_moved_robot(yaw: float, shift: tuple[float, float]) -> None:
    alignment = feet_alignment(PLANNED, moved(PLANNED, yaw, shift))
    aligned = np.array([alignment.position(foot) for foot in PLANNED])
    np.testing.assert_allclose(aligned, moved(PLANNED, yaw, shift), atol=1e-12)
    assert wrap_angle(alignment.yaw - yaw) == pytest.approx(0.0, abs=1e-12)


def test_plan_stays_where_it_is_when_the_feet_are_where_they_were_planned() -> None:
    alignment = feet_alignment(PLANNED, PLANNED)
    np.testing.assert_allclose(alignment.origin(), np.zeros(3), atol=1e-15)
    np.testing.assert_allclose(alignment.position(TORSO), TORSO, atol=1e-15)


def test_one_misplaced_foot_moves_the_plan_by_a_quarter_of_its_error() -> None:
    measured = PLANNED.copy()
    measured[2, 0] += 0.04
    alignment = feet_alignment(PLANNED, measured)
    middle = PLANNED.mean(axis=0)
    np.testing.assert_allclose(alignment.position(middle) - middle, [0.01, 0.0], atol=1e-12)


def test_heading_is_that_of_the_middle_of_the_feet() -> None:
    """A fore foot that is misplaced sideways turns the plan by half of what the line of the left feet turns by."""
    square = np.array([[0.3, 0.2], [0.3, -0.2], [-0.3, 0.2], [-0.3, -0.2]])
    measured = square.copy()
    measured[0, 1] += 0.06
    assert feet_alignment(square, measured).yaw == pytest.approx(math.atan2(0.03, 0.6))


@motions
def test_planned_base_is_laid_on_the_measured_base(yaw: float, shift: tuple[float, float]) -> None:
    measured, heading = moved(TORSO, yaw, shift), 0.4 + yaw
    alignment = base_alignment(TORSO, 0.4, measured, heading)
    np.testing.assert_allclose(alignment.position(TORSO), measured, atol=1e-12)
    assert wrap_angle(0.4 + alignment.yaw - heading) == pytest.approx(0.0, abs=1e-12)


@motions
def test_directions_turn_and_do_not_shift(yaw: float, shift: tuple[float, float]) -> None:
    alignment = feet_alignment(PLANNED, moved(PLANNED, yaw, shift))
    between = alignment.position(PLANNED[0]) - alignment.position(PLANNED[3])
    np.testing.assert_allclose(alignment.vector(PLANNED[0] - PLANNED[3]), between, atol=1e-12)


@motions
def test_origin_is_the_pose_of_the_plan_frame(yaw: float, shift: tuple[float, float]) -> None:
    origin = feet_alignment(PLANNED, moved(PLANNED, yaw, shift)).origin()
    np.testing.assert_allclose(moved(PLANNED, float(origin[2]), (origin[0], origin[1])), moved(PLANNED, yaw, shift))


def jump() -> PlanarPose:
    return feet_alignment(PLANNED, moved(PLANNED, 0.3, (0.1, -0.05)))


@pytest.mark.parametrize("raw", [jump(), base_alignment(TORSO, 0.0, TORSO + 0.1, -0.2)])
def test_smoothed_alignment_does_not_jump_at_the_torso(raw: PlanarPose) -> None:
    """In one tick torso and yaw go no more than the filter's share of the jump."""
    smoothed = SmoothedAlignment(TIME_CONSTANT, identity_alignment()).update(raw, TORSO, PERIOD)
    share = 1.0 - math.exp(-PERIOD / TIME_CONSTANT)
    size = np.linalg.norm(raw.position(TORSO) - TORSO)
    lever = np.linalg.norm(TORSO - raw.point_in_plan)
    assert smoothed.yaw == pytest.approx(share * raw.yaw)
    assert np.linalg.norm(smoothed.position(TORSO) - TORSO) <= share * (size + 2.0 * abs(raw.yaw) * lever)


def test_smoothed_alignment_converges_with_its_time_constant() -> None:
    raw = base_alignment(TORSO, 0.0, TORSO + 0.1, -0.2)
    smoothing = SmoothedAlignment(TIME_CONSTANT, identity_alignment())
    remaining = []
    for _ in range(round(8.0 * TIME_CONSTANT / PERIOD)):
        now = smoothing.update(raw, TORSO, PERIOD)
        remaining.append([*(raw.position(TORSO) - now.position(TORSO)), raw.yaw - now.yaw])
    after_one = remaining[round(TIME_CONSTANT / PERIOD) - 1]
    np.testing.assert_allclose(after_one, math.exp(-1.0) * np.array([0.1, 0.1, -0.2]), rtol=1e-9)
    np.testing.assert_allclose(remaining[-1], 0.0, atol=1e-4)


def test_smoothed_alignment_lets_a_steady_plan_alone() -> None:
    raw = jump()
    smoothing = SmoothedAlignment(TIME_CONSTANT, raw)
    for step in range(5):
        torso = TORSO + 0.1 * step
        np.testing.assert_allclose(smoothing.update(raw, torso, PERIOD).origin(), raw.origin(), atol=1e-12)


def test_smoothed_alignment_takes_the_short_way_round() -> None:
    """From just below +180 to just above -180 degrees the plan turns by 2, not by 358 degrees."""
    before, after = (PlanarPose((0.0, 0.0), (0.0, 0.0), math.radians(angle)) for angle in (179.0, -179.0))
    smoothing = SmoothedAlignment(TIME_CONSTANT, before)
    for _ in range(20):
        yaw = smoothing.update(after, TORSO, PERIOD).yaw
        assert abs(wrap_angle(yaw - math.pi)) <= math.radians(1.0) + 1e-12
