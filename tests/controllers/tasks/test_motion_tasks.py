"""Motion tasks: their rows are second derivatives, and what they ask for reduces errors."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from controller_cases import STANCES, any_state, integrated, reference_at

from quadlab.controllers.reference import ControlReference
from quadlab.controllers.task_levels import build_task
from quadlab.controllers.tasks.base_height import BaseHeightTask
from quadlab.controllers.tasks.base_orientation import BaseRollPitchTask, BaseYawTask
from quadlab.controllers.tasks.base_position import BasePositionTask
from quadlab.controllers.tasks.com_position import ComPositionTask
from quadlab.controllers.tasks.contact_force_minimisation import ContactForceMinimisationTask
from quadlab.controllers.tasks.swing_feet import SwingFeetTask
from quadlab.controllers.tasks.task import Task, Variable
from quadlab.geometry.rotations import Array, rotation_log, rotation_z, yaw_of
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.model import RobotModel

STEP = 1e-4  # [s]
STIFFNESS, DAMPING = 70.0, 9.0
CONFIGS: dict[str, type] = {
    "com_position": ComPositionTask.Config,
    "base_position": BasePositionTask.Config,
    "base_height": BaseHeightTask.Config,
    "base_yaw": BaseYawTask.Config,
    "base_roll_pitch": BaseRollPitchTask.Config,
    "swing_feet": SwingFeetTask.Config,
}
motion_tasks = pytest.mark.parametrize("name", CONFIGS)


def task(name: str, proportional: float, derivative: float) -> Task:
    config = CONFIGS[name](task=name, proportional_per_s2=proportional, derivative_per_s=derivative)
    return build_task(config)


def second_difference(values: Callable[[Kinematics], Array], along: list[Kinematics]) -> Array:
    before, now, after = (values(kinematics) for kinematics in along)
    return (before - 2.0 * now + after) / STEP**2


def angular_acceleration(along: list[Kinematics]) -> Array:
    """Change of the rotation increments from one interval to the next, in the heading frame."""
    before, now, after = (kinematics.base_rotation for kinematics in along)
    change = rotation_log(after @ now.T) - rotation_log(now @ before.T)
    return rotation_z(-yaw_of(now)) @ change / STEP**2


def task_acceleration(name: str, along: list[Kinematics], swing: list[int]) -> Array:
    if name == "com_position":
        return second_difference(lambda kinematics: kinematics.com_position[:2], along)
    if name == "base_position":
        return second_difference(lambda kinematics: kinematics.base_position[:2], along)
    if name == "base_height":
        return second_difference(lambda kinematics: kinematics.base_position[2:3], along)
    if name == "swing_feet":
        return second_difference(lambda kinematics: kinematics.foot_positions[swing].ravel(), along)
    return angular_acceleration(along)[slice(2, 3) if name == "base_yaw" else slice(0, 2)]


@motion_tasks
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("stance", STANCES[1:], ids=str)
def test_rows_are_the_second_derivative(robot: RobotModel, name: str, seed: int, stance: list[int]) -> None:
    """With no gains and no feed-forward, matrix u_dot - target is matrix u_dot + bias: the task's acceleration."""
    state = any_state(robot, seed)
    acceleration = np.random.default_rng(100 + seed).normal(size=18)
    along = [robot.kinematics(integrated(robot, state, acceleration, time)) for time in (-STEP, 0.0, STEP)]
    reference = reference_at(robot, along[1], stance)
    rows = task(name, 0.0, 0.0).rows(along[1], reference)
    assert rows.variable is Variable.ACCELERATION
    assert rows.lower is rows.upper
    expected = task_acceleration(name, along, reference.swing_legs)
    np.testing.assert_allclose(rows.matrix @ acceleration - rows.upper, expected, atol=2e-5)


def displaced(robot: RobotModel, kinematics: Kinematics) -> tuple[ControlReference, dict[str, Array]]:
    """A reference with known errors, and what PD with ``STIFFNESS`` and ``DAMPING`` makes of them for each task."""
    generator = np.random.default_rng(1)
    offset, rate, feed_forward = generator.normal(size=(3, 4, 3))
    turn, heading = 0.2 * offset[0], rotation_z(-yaw_of(kinematics.base_rotation))
    exact = reference_at(robot, kinematics, [0, 2])
    reference = replace(
        exact,
        com_position=exact.com_position + offset[1, :2],
        base_position=exact.base_position + offset[3, :2],
        com_velocity=exact.com_velocity + rate[1, :2],
        com_acceleration=feed_forward[1, :2],
        base_height=exact.base_height + offset[2, 0],
        base_velocity=exact.base_velocity + rate[3],
        base_acceleration=feed_forward[3],
        base_rotation=pin.exp3(turn) @ exact.base_rotation,
        base_angular_velocity=exact.base_angular_velocity + rate[0],
        base_angular_acceleration=feed_forward[0],
        foot_positions=exact.foot_positions + offset,
        foot_velocities=exact.foot_velocities + rate,
        foot_accelerations=exact.foot_accelerations + feed_forward,
    )
    rotational = heading @ (STIFFNESS * turn + DAMPING * rate[0] + feed_forward[0])
    return reference, {
        "com_position": STIFFNESS * offset[1, :2] + DAMPING * rate[1, :2] + feed_forward[1, :2],
        "base_position": STIFFNESS * offset[3, :2] + DAMPING * rate[3, :2] + feed_forward[3, :2],
        "base_height": STIFFNESS * offset[2, :1] + DAMPING * rate[3, 2:] + feed_forward[3, 2:],
        "base_yaw": rotational[2:],
        "base_roll_pitch": rotational[:2],
        "swing_feet": (STIFFNESS * offset + DAMPING * rate + feed_forward)[[1, 3]].ravel(),
    }


@motion_tasks
def test_errors_are_pulled_towards_the_reference(robot: RobotModel, name: str) -> None:
    kinematics = robot.kinematics(any_state(robot, 4))
    reference, expected = displaced(robot, kinematics)
    free = task(name, 0.0, 0.0).rows(kinematics, reference_at(robot, kinematics, [0, 2])).upper
    asked = task(name, STIFFNESS, DAMPING).rows(kinematics, reference).upper - free
    np.testing.assert_allclose(asked, expected[name], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(("name", "rows"), [("base_yaw", slice(2, 3)), ("base_roll_pitch", slice(0, 2))])
def test_base_that_is_almost_upside_down_is_pulled_back_the_short_way(
    robot: RobotModel, name: str, rows: slice
) -> None:
    """Near half a turn, where the usual formula of the error loses the axis."""
    kinematics = robot.kinematics(any_state(robot, 4))
    turn = (np.pi - 1e-4) * np.array([2.0, -1.0, 2.0]) / 3.0
    exact = reference_at(robot, kinematics)
    reference = replace(exact, base_rotation=pin.exp3(turn) @ exact.base_rotation)
    free = task(name, 0.0, 0.0).rows(kinematics, exact).upper
    asked = task(name, STIFFNESS, DAMPING).rows(kinematics, reference).upper - free
    expected = STIFFNESS * rotation_z(-yaw_of(kinematics.base_rotation)) @ turn
    np.testing.assert_allclose(asked, expected[rows], rtol=1e-6)


def test_no_swing_leg_asks_for_nothing(robot: RobotModel) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    rows = task("swing_feet", 1.0, 1.0).rows(kinematics, reference_at(robot, kinematics))
    assert rows.matrix.shape == (0, 18)
    assert rows.upper.shape == (0,)


@pytest.mark.parametrize("stance", STANCES, ids=str)
def test_force_minimisation_asks_for_no_force(robot: RobotModel, stance: list[int]) -> None:
    config = ContactForceMinimisationTask.Config(task="contact_force_minimisation")
    kinematics = robot.kinematics(robot.nominal_state())
    rows = build_task(config).rows(kinematics, reference_at(robot, kinematics, stance))
    assert rows.variable is Variable.FORCE
    np.testing.assert_array_equal(rows.matrix, np.eye(3 * len(stance)))
    np.testing.assert_array_equal(rows.lower, np.zeros(3 * len(stance)))
    np.testing.assert_array_equal(rows.upper, np.zeros(3 * len(stance)))
