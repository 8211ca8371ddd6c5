"""Motion tasks in the control frame: what they say on level ground and on a slope."""

from dataclasses import replace

import numpy as np
import pytest
from controller_cases import any_state, controller_config, integrated, reference_at, shipped
from pydantic import ValidationError

from quadlab.controllers.reference import ControlReference
from quadlab.controllers.task_levels import LevelConfig, build_task
from quadlab.controllers.tasks.task import Task
from quadlab.controllers.tracking.torso import ground_axes
from quadlab.estimation.terrain_plane import fit_plane
from quadlab.geometry.rotations import Array, rotation_log
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.model import RobotModel

STEP = 1e-4  # [s]
SLOPE = np.array([0.2, -0.1])
HEADING = 0.7  # [rad]
AXES_OF = {
    "com_position": slice(0, 2),
    "base_position": slice(0, 2),
    "base_height": slice(2, 3),
    "base_yaw": slice(2, 3),
    "base_roll_pitch": slice(0, 2),
}
framed_tasks = pytest.mark.parametrize("name", AXES_OF)


def framed(name: str, proportional: float, derivative: float, **options: str) -> Task:
    values = {"task": name, "proportional_per_s2": proportional, "derivative_per_s": derivative, **options}
    return build_task(LevelConfig.model_validate({"name": "motion", "tasks": [values]}).tasks[0])


def axes_of_a_slope() -> Array:
    points = np.array([[1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]])
    points[:, 2] = points[:, :2] @ SLOPE
    return ground_axes(HEADING, fit_plane(points, np.zeros(2)))


def disturbed_reference(robot: RobotModel, kinematics: Kinematics) -> ControlReference:
    """A reference in whose every part the robot has an error."""
    exact, generator = reference_at(robot, kinematics), np.random.default_rng(3)
    noise = generator.normal(size=(5, 3))
    return replace(
        exact,
        com_position=exact.com_position + noise[0, :2],
        com_velocity=exact.com_velocity + noise[1, :2],
        com_acceleration=noise[2, :2],
        base_position=exact.base_position + noise[3, :2],
        base_height=exact.base_height + noise[0, 2],
        base_velocity=exact.base_velocity + noise[1],
        base_acceleration=noise[4],
        base_angular_velocity=exact.base_angular_velocity + noise[3],
        base_angular_acceleration=noise[2],
    )


def observed(name: str, along: list[Kinematics]) -> Array:
    """Second derivative in world axes of what a task is about, (3,)."""
    before, now, after = along
    if name in ("base_yaw", "base_roll_pitch"):
        turned = rotation_log(after.base_rotation @ now.base_rotation.T)
        return (turned - rotation_log(now.base_rotation @ before.base_rotation.T)) / STEP**2
    points = [at.com_position if name == "com_position" else at.base_position for at in along]
    difference: Array = (points[0] - 2.0 * points[1] + points[2]) / STEP**2
    return difference


@framed_tasks
def test_level_ground_and_heading_along_x_change_nothing(robot: RobotModel, name: str) -> None:
    """But for roll and pitch, whose axes in the world are those of the measured heading."""
    state = any_state(robot, 4)
    if name == "base_roll_pitch":
        state = replace(state, quat_wxyz=robot.nominal_state().quat_wxyz)
    kinematics = robot.kinematics(state)
    reference = disturbed_reference(robot, kinematics)
    in_world, on_ground = (
        framed(name, 70.0, 9.0, frame=frame).rows(kinematics, reference) for frame in ("world", "control")
    )
    np.testing.assert_allclose(on_ground.matrix, in_world.matrix, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(on_ground.upper, in_world.upper, rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize("name", [name for name in AXES_OF if name != "base_height"])
@pytest.mark.parametrize("seed", range(3))
def test_rows_are_the_second_derivative_along_the_axes_of_the_ground(robot: RobotModel, name: str, seed: int) -> None:
    state, axes = any_state(robot, seed), axes_of_a_slope()
    acceleration = np.random.default_rng(100 + seed).normal(size=18)
    along = [robot.kinematics(integrated(robot, state, acceleration, time)) for time in (-STEP, 0.0, STEP)]
    reference = replace(reference_at(robot, along[1]), ground_axes=axes)
    rows = framed(name, 0.0, 0.0, frame="control").rows(along[1], reference)
    expected = (axes.T @ observed(name, along))[AXES_OF[name]]
    np.testing.assert_allclose(rows.matrix @ acceleration - rows.upper, expected, atol=2e-5)


@pytest.mark.parametrize("name", ["com_position", "base_position", "base_height"])
def test_a_robot_that_climbs_as_planned_has_no_error(robot: RobotModel, name: str) -> None:
    """Planned is a motion over level ground; on a slope it goes along the slope, so that nothing is to be corrected."""
    state = replace(robot.nominal_state(), linear_velocity_base_in_world=np.array([0.3, 0.1, SLOPE @ [0.3, 0.1]]))
    kinematics = robot.kinematics(state)
    exact = reference_at(robot, kinematics)
    level_velocity = np.array([*exact.base_velocity[:2], 0.0])
    reference = replace(exact, base_velocity=level_velocity, ground_axes=axes_of_a_slope())
    free, tracked = (framed(name, *gains, frame="control").rows(kinematics, reference).upper.copy() for gains in
                     ((0.0, 0.0), (70.0, 9.0)))  # fmt: skip
    np.testing.assert_allclose(tracked, free, atol=1e-10)


@pytest.mark.parametrize("name", ["com_position", "base_position"])
def test_error_uphill_is_corrected_along_the_slope(robot: RobotModel, name: str) -> None:
    """Heights, which other tasks may have to give up, are no part of it."""
    kinematics, axes = robot.kinematics(robot.nominal_state()), axes_of_a_slope()
    exact = replace(reference_at(robot, kinematics), ground_axes=axes)
    ahead = 0.1 * axes[:2, 0]
    further = replace(
        exact,
        com_position=exact.com_position + ahead,
        base_position=exact.base_position + ahead,
        base_height=exact.base_height + 0.3,
    )
    task = framed(name, 100.0, 0.0, frame="control")
    asked = task.rows(kinematics, further).upper.copy() - task.rows(kinematics, exact).upper
    np.testing.assert_allclose(asked, [100.0 * 0.1, 0.0], atol=1e-9)


def test_height_is_vertical_also_over_a_slope(robot: RobotModel) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    exact = replace(reference_at(robot, kinematics), ground_axes=axes_of_a_slope())
    higher = replace(exact, base_height=exact.base_height + 0.05, base_position=exact.base_position + 0.1)
    rows = framed("base_height", 100.0, 0.0, frame="control").rows(kinematics, higher)
    np.testing.assert_array_equal(rows.matrix, kinematics.base_jacobian[2:3])
    np.testing.assert_allclose(rows.upper + kinematics.base_bias[2], 100.0 * 0.05)


def test_options_left_at_their_default_are_not_written() -> None:
    """So that a new option does not give every trial that was ever run another identity."""
    written = controller_config().model_dump(mode="json")["levels"]
    assert written == shipped("controller/hierarchical.yaml")["levels"]
    level = {"name": "height", "tasks": [{"task": "base_height", "proportional_per_s2": 1.0, "derivative_per_s": 1.0}]}
    asked = {**level, "tasks": [{**level["tasks"][0], "frame": "control"}]}  # type: ignore[dict-item]
    assert LevelConfig.model_validate(level).model_dump(mode="json") == level
    assert LevelConfig.model_validate(asked).model_dump(mode="json") == asked


def test_an_unknown_frame_is_refused() -> None:
    with pytest.raises(ValidationError, match="'world' or 'control'"):
        framed("base_height", 1.0, 1.0, frame="ground")
