"""The desired motion of the base: under the CoM, or as it is planned."""

import numpy as np
import pytest

from quadlab.controllers.tracking.alignment import PlanarPose
from quadlab.controllers.tracking.torso import torso_rotation
from quadlab.controllers.tracking.torso_motion import (
    Ground,
    NominalStance,
    planned_torso,
    torso_under_com,
)
from quadlab.estimation.terrain_plane import TerrainPlane
from quadlab.geometry.pose_curve import PoseCurve, PoseMotion, pose_curve
from quadlab.geometry.rotations import Array, matrix_to_quat, rotation_2d, rotation_log, rotation_zyx

LEVEL = Ground(TerrainPlane((0.0, 0.0), 0.0, (0.0, 0.0)), 0.0, 0.5)
WHERE_IT_WAS = PlanarPose((0.0, 0.0), (0.0, 0.0), 0.0)
ALIGNED = PlanarPose((0.1, -0.2), (1.5, 0.7), 0.6)
STEP = 1e-4  # [s]


def swaying() -> PoseCurve:
    times = np.linspace(0.0, 2.0, 21)
    positions = np.column_stack([0.2 * times, 0.05 * np.sin(3.0 * times), 0.45 + 0.01 * np.cos(4.0 * times)])
    quats = [
        matrix_to_quat(rotation_zyx(0.2 * t, 0.05 * float(np.sin(2.0 * t)), 0.03 * float(np.cos(t)))) for t in times
    ]
    return pose_curve(times, positions, np.array(quats))


def at(time_s: float, alignment: PlanarPose = ALIGNED, rate: float = 1.0, ground: Ground = LEVEL) -> PoseMotion:
    return planned_torso(swaying().motion(time_s), alignment, (rate, 0.0), ground)


def test_plan_that_lies_where_it_was_made_is_followed_as_it_is() -> None:
    planned, found = swaying().motion(0.73), at(0.73, WHERE_IT_WAS)
    np.testing.assert_allclose(found.rotation, planned.rotation, atol=1e-12)
    for name in ("position", "velocity", "acceleration", "angular_velocity", "angular_acceleration"):
        np.testing.assert_allclose(getattr(found, name), getattr(planned, name), atol=1e-12)


@pytest.mark.parametrize("rate", [1.0, 0.4])
def test_velocities_are_derivatives_in_the_world(rate: float) -> None:
    before, now, after = (at(0.73 + rate * step, rate=rate) for step in (-STEP, 0.0, STEP))
    difference: Array = (after.position - before.position) / (2.0 * STEP)
    np.testing.assert_allclose(now.velocity, difference, atol=1e-6)
    np.testing.assert_allclose(now.acceleration, (after.velocity - before.velocity) / (2.0 * STEP), atol=1e-4)
    turned = rotation_log(after.rotation @ before.rotation.T) / (2.0 * STEP)
    np.testing.assert_allclose(now.angular_velocity, turned, atol=1e-6)
    change = (after.angular_velocity - before.angular_velocity) / (2.0 * STEP)
    np.testing.assert_allclose(now.angular_acceleration, change, atol=1e-4)


def test_clock_that_runs_down_brakes_the_base() -> None:
    planned = swaying().motion(0.73)
    found = planned_torso(planned, WHERE_IT_WAS, (0.5, -2.0), LEVEL)
    np.testing.assert_allclose(found.acceleration, 0.25 * planned.acceleration - 2.0 * planned.velocity)
    change = 0.25 * planned.angular_acceleration - 2.0 * planned.angular_velocity
    np.testing.assert_allclose(found.angular_acceleration, change)


def test_base_keeps_its_planned_height_and_lean_over_sloped_ground() -> None:
    plane = TerrainPlane((0.0, 0.0), 0.1, (0.2, 0.0))
    found, level = at(0.73, WHERE_IT_WAS, ground=Ground(plane, 0.16, 0.5)), at(0.73, WHERE_IT_WAS)
    assert found.position[2] - level.position[2] == pytest.approx(0.16)
    heading = float(np.arctan2(level.rotation[1, 0], level.rotation[0, 0]))
    upright = rotation_zyx(heading, 0.0, 0.0)
    lean = torso_rotation(heading, plane, 0.5).T @ found.rotation
    np.testing.assert_allclose(lean, upright.T @ level.rotation, atol=1e-12)


def test_base_under_the_com_moves_with_it_at_standing_height() -> None:
    com = (np.array([1.0, 2.0]), np.array([0.3, 0.1]), np.array([0.5, -0.4]))
    found = torso_under_com(com, (0.5, 0.2), LEVEL._replace(height=0.05), NominalStance((0.02, -0.01), 0.47))
    np.testing.assert_allclose(found.position[:2] + rotation_2d(0.5) @ [0.02, -0.01], com[0])
    assert found.position[2] == pytest.approx(0.52)
    np.testing.assert_allclose(found.velocity, [0.3, 0.1, 0.0])
    np.testing.assert_allclose(found.acceleration, [0.5, -0.4, 0.0])
    np.testing.assert_allclose(found.angular_velocity, [0.0, 0.0, 0.2])
    np.testing.assert_allclose(found.angular_acceleration, 0.0)
