"""Limits on positions: their rows bind exactly where the second-order prediction meets the bound."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pytest
from controller_cases import STANCES, any_state, disturbed_state, integrated, reference_at

from quadlab.controllers.limits.second_order import position_limit
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.task_levels import LevelConfig, build_task
from quadlab.controllers.tasks.task import TaskRows, Variable
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.model import RobotModel

STEP = 1e-4  # [s]
LOOK_AHEAD = 0.1  # [s]
MINIMUM, MAXIMUM = 0.6, 1.06


@dataclass(frozen=True)
class Limited:
    """A limit, the position that it limits, and its bounds."""

    config: Mapping[str, float]
    position: Callable[[Kinematics, list[int]], Array]
    bounds: Callable[[RobotModel], tuple[Array, Array]]


def height_bounds(robot: RobotModel) -> tuple[Array, Array]:
    height = robot.nominal_state().position_base_in_world[2]
    return np.array(MINIMUM * height), np.array(MAXIMUM * height)


HEIGHTS = {"minimum": MINIMUM, "maximum": MAXIMUM, "look_ahead_s": LOOK_AHEAD}
LIMITS = {
    "joint_position_limits": Limited(
        {"look_ahead_s": LOOK_AHEAD},
        lambda kinematics, _: kinematics.joint_positions,
        lambda robot: (robot.joint_position_limits[:, 0], robot.joint_position_limits[:, 1]),
    ),
    "limb_extension": Limited(
        HEIGHTS,
        lambda kinematics, _: kinematics.hip_positions[:, 2] - kinematics.foot_positions[:, 2],
        height_bounds,
    ),
    "height_over_footprint": Limited(
        HEIGHTS,
        lambda kinematics, stance: np.array(
            [kinematics.base_position[2] - kinematics.foot_positions[stance, 2].mean()]
        ),
        height_bounds,
    ),
}
limits = pytest.mark.parametrize("name", LIMITS)


def rows_of(name: str, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
    level = LevelConfig.model_validate({"name": name, "tasks": [{"task": name, **LIMITS[name].config}]})
    return build_task(level.tasks[0]).rows(kinematics, reference)


def moving_part(name: str, kinematics: Kinematics) -> Array:
    """The limited position without the feet, whose own motion is no part of these limits."""
    if name == "limb_extension":
        return kinematics.hip_positions[:, 2]
    return kinematics.base_position[2:3] if name == "height_over_footprint" else kinematics.joint_positions


@limits
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("stance", STANCES[:-1], ids=str)
def test_rows_bind_exactly_where_the_prediction_meets_the_bound(
    robot: RobotModel, name: str, seed: int, stance: list[int]
) -> None:
    """Finite differences of r give r_dot and r_ddot; the room of a row is that of the prediction, per dt^2 / 2."""
    state = any_state(robot, seed)
    acceleration = np.random.default_rng(50 + seed).normal(size=18)
    along = [robot.kinematics(integrated(robot, state, acceleration, time)) for time in (-STEP, 0.0, STEP)]
    before, now, after = (moving_part(name, kinematics) for kinematics in along)
    velocity, change = (after - before) / (2.0 * STEP), (after - 2.0 * now + before) / STEP**2
    position = LIMITS[name].position(along[1], stance)
    predicted = position + LOOK_AHEAD * velocity + 0.5 * LOOK_AHEAD**2 * change
    rows = rows_of(name, along[1], reference_at(robot, along[1], stance))
    lower, upper = LIMITS[name].bounds(robot)
    assert rows.variable is Variable.ACCELERATION
    per_metre = 2.0 / LOOK_AHEAD**2
    np.testing.assert_allclose(rows.upper - rows.matrix @ acceleration, per_metre * (upper - predicted), atol=1e-4)
    np.testing.assert_allclose(rows.matrix @ acceleration - rows.lower, per_metre * (predicted - lower), atol=1e-4)


@pytest.mark.parametrize("dt", [0.01, 0.1, 0.5])
def test_an_acceleration_on_the_bound_reaches_it_after_the_look_ahead(dt: float) -> None:
    """One degree of freedom, closed form: x0 + v dt + a dt^2 / 2 = bound."""
    position, velocity, bounds = np.array([0.2]), np.array([-0.4]), (-1.0, 1.5)
    rows = position_limit(np.eye(1), np.zeros(1), position, velocity, bounds, dt)
    for acceleration, bound in zip((rows.lower, rows.upper), bounds, strict=True):
        assert (position + velocity * dt + 0.5 * acceleration * dt**2)[0] == pytest.approx(bound)


@pytest.mark.parametrize("stance", STANCES, ids=str)
def test_a_leg_that_reaches_too_far_pulls_its_hip_down(robot: RobotModel, stance: list[int]) -> None:
    """The foot in a hole asks for a hip that falls: the row forbids everything else; the other legs are free."""
    kinematics = robot.kinematics(robot.nominal_state())
    depth = np.zeros((4, 3))
    depth[1, 2] = 0.3 * robot.nominal_state().position_base_in_world[2]
    in_a_hole = kinematics._replace(foot_positions=kinematics.foot_positions - depth)
    rows = rows_of("limb_extension", in_a_hole, reference_at(robot, in_a_hole, stance))
    assert rows.upper[1] < 0.0
    assert np.all(rows.upper[[0, 2, 3]] > 0.0)
    assert np.all(rows.lower < 0.0)
    falling, rising = np.zeros(18), np.zeros(18)
    falling[2], rising[2] = 2.0 * rows.upper[1], -2.0 * rows.upper[1]
    assert rows.matrix[1] @ falling < rows.upper[1] < rows.matrix[1] @ rising


def test_a_leg_that_is_squeezed_pushes_its_hip_up(robot: RobotModel) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    height = np.zeros((4, 3))
    height[2, 2] = 0.6 * robot.nominal_state().position_base_in_world[2]
    on_a_box = kinematics._replace(foot_positions=kinematics.foot_positions + height)
    rows = rows_of("limb_extension", on_a_box, reference_at(robot, on_a_box))
    assert rows.lower[2] > 0.0
    assert np.all(rows.lower[[0, 1, 3]] < 0.0)


def test_footprint_counts_standing_feet_only(robot: RobotModel) -> None:
    kinematics = robot.kinematics(disturbed_state(robot, 0))
    raised = kinematics.foot_positions.copy()
    raised[[0, 3], 2] += 0.2
    changed = kinematics._replace(foot_positions=raised)
    diagonal = [1, 2]
    expected = rows_of("height_over_footprint", kinematics, reference_at(robot, kinematics, diagonal))
    rows = rows_of("height_over_footprint", changed, reference_at(robot, changed, diagonal))
    np.testing.assert_array_equal(rows.upper, expected.upper)
    np.testing.assert_array_equal(rows.lower, expected.lower)


def test_robot_without_standing_feet_has_no_footprint(robot: RobotModel) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    rows = rows_of("height_over_footprint", kinematics, reference_at(robot, kinematics, []))
    assert rows.matrix.shape == (0, 18)
    assert rows.lower.shape == rows.upper.shape == (0,)


@limits
def test_nominal_stance_is_inside(robot: RobotModel, name: str) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    rows = rows_of(name, kinematics, reference_at(robot, kinematics))
    assert np.all(rows.lower <= 0.0)
    assert np.all(rows.upper >= 0.0)
