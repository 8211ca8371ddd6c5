"""Tasks on torques, joints in the air and the posture of the knees."""

from dataclasses import replace

import numpy as np
import pytest
from controller_cases import STANCES, any_state, integrated, reference_at, robot_named

from quadlab.controllers.task_levels import build_task
from quadlab.controllers.tasks.manipulability_height import (
    ManipulabilityHeightTask,
    knee_gradient,
    leg_manipulability,
)
from quadlab.controllers.tasks.swing_joint_hold import SwingJointHoldTask
from quadlab.controllers.tasks.task import TaskRows, Variable
from quadlab.controllers.tasks.torque_minimisation import TorqueMinimisationTask
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import JOINTS, Kinematics
from quadlab.robots.legs import joints_of
from quadlab.robots.model import RobotModel

STEP = 1e-5  # [rad]
PULL, DAMPING = 12.0, 3.0


def leg_jacobian(kinematics: Kinematics, leg: int) -> Array:
    jacobian: Array = kinematics.foot_jacobians[leg][:, JOINTS][:, joints_of(leg)]
    return jacobian


def with_knee(robot: RobotModel, seed: int, leg: int, change: float) -> Kinematics:
    state = any_state(robot, seed)
    joints = state.joint_positions.copy()
    joints[3 * leg + 2] += change
    return robot.kinematics(replace(state, joint_positions=joints))


@pytest.mark.parametrize("leg", range(4))
@pytest.mark.parametrize("seed", range(3))
def test_knee_gradient_is_the_derivative_of_the_manipulability(robot: RobotModel, leg: int, seed: int) -> None:
    here = with_knee(robot, seed, leg, 0.0)
    before, after = (
        leg_manipulability(leg_jacobian(with_knee(robot, seed, leg, change), leg)) for change in (-STEP, STEP)
    )
    gradient = knee_gradient(leg_jacobian(here, leg), here.leg_joint_axes[leg])
    assert gradient == pytest.approx((after - before) / (2.0 * STEP), rel=1e-6, abs=1e-8)


@pytest.mark.parametrize("seed", range(3))
def test_manipulability_is_the_root_of_the_gram_determinant(robot: RobotModel, seed: int) -> None:
    jacobian = leg_jacobian(robot.kinematics(any_state(robot, seed)), 1)
    assert leg_manipulability(jacobian) == pytest.approx(np.sqrt(np.linalg.det(jacobian @ jacobian.T)), rel=1e-9)


def manipulability_height(damping: float) -> ManipulabilityHeightTask:
    config = ManipulabilityHeightTask.Config(task="manipulability_height", pull=PULL, damping_per_s=damping)
    return ManipulabilityHeightTask(config)


def height_acceleration(robot: RobotModel, kinematics: Kinematics, damping: float = DAMPING) -> float:
    """What the task asks of the base's vertical acceleration."""
    rows = manipulability_height(damping).rows(kinematics, reference_at(robot, kinematics))
    np.testing.assert_array_equal(rows.matrix, kinematics.base_jacobian[2:3])
    return float(rows.upper[0] + kinematics.base_bias[2])


def squatting(robot: RobotModel, knee: float) -> Kinematics:
    """The nominal stance with all knees bent by ``knee`` and thighs turned so that the feet stay below the hips."""
    state = robot.nominal_state()
    joints = state.joint_positions.copy()
    joints[2::3] = knee * np.sign(joints[2::3])
    joints[1::3] = -0.5 * joints[2::3]
    return robot.kinematics(replace(state, joint_positions=joints))


def test_straight_knees_sink_and_folded_knees_rise(robot: RobotModel) -> None:
    """In between a leg moves its foot best; the height is pulled there from both sides."""
    assert height_acceleration(robot, squatting(robot, 0.3)) < -1e-3
    assert height_acceleration(robot, squatting(robot, 2.2)) > 1e-3


def test_manipulability_does_not_depend_on_the_side_the_knees_point_to() -> None:
    """Fore and hind knees of these robots point towards each other: their pulls add up."""
    robot = robot_named("anymal_b")
    kinematics = squatting(robot, 0.4)
    gradients = [
        knee_gradient(leg_jacobian(kinematics, leg), kinematics.leg_joint_axes[leg]) for leg in range(4)
    ]  # of the fore and the hind knees of opposite signs
    assert np.ptp(np.abs(gradients)) < 0.05 * np.abs(gradients).max()
    assert height_acceleration(robot, kinematics) == pytest.approx(-PULL * sum(np.abs(gradients)))


def test_pull_of_a_leg_does_not_jump_when_its_shank_is_vertical() -> None:
    """A knee lengthens its leg, or shortens it, wherever the thigh points."""
    robot = robot_named("anymal_b")
    nominal = robot.nominal_state()
    pulls = []
    for thigh in np.linspace(-0.6, 0.6, 121):
        joints = nominal.joint_positions.copy()
        joints[1] += thigh
        pulls.append(height_acceleration(robot, robot.kinematics(replace(nominal, joint_positions=joints))))
    assert np.abs(np.diff(pulls)).max() < 0.05 * np.ptp(pulls) + 1e-3


def test_vertical_speed_is_damped(robot: RobotModel) -> None:
    kinematics = robot.kinematics(any_state(robot, 2))
    change = height_acceleration(robot, kinematics, DAMPING) - height_acceleration(robot, kinematics, 0.0)
    assert change == pytest.approx(-DAMPING * kinematics.base_linear_velocity[2])


def swing_joint_rows(robot: RobotModel, kinematics: Kinematics, stance: list[int]) -> TaskRows:
    task = build_task(SwingJointHoldTask.Config(task="swing_joint_hold"))
    return task.rows(kinematics, reference_at(robot, kinematics, stance))


@pytest.mark.parametrize("stance", STANCES, ids=str)
def test_joints_in_the_air_are_not_accelerated(robot: RobotModel, stance: list[int]) -> None:
    """Rows and target are the change of the joint velocities of the legs in the air, and of no other joint."""
    state = any_state(robot, 1)
    kinematics = robot.kinematics(state)
    rows = swing_joint_rows(robot, kinematics, stance)
    acceleration = np.random.default_rng(3).normal(size=18)
    later = integrated(robot, state, acceleration, 1e-3)
    change = ((later.joint_velocities - state.joint_velocities) / 1e-3).reshape(4, 3)
    in_air = [leg for leg in range(4) if leg not in stance]
    assert rows.variable is Variable.ACCELERATION
    np.testing.assert_allclose(rows.matrix @ acceleration - rows.upper, change[in_air].ravel(), atol=1e-9)
    np.testing.assert_array_equal(rows.lower, rows.upper)


@pytest.mark.parametrize("stance", STANCES, ids=str)
def test_torque_minimisation_asks_for_no_torque(robot: RobotModel, stance: list[int]) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    task = build_task(TorqueMinimisationTask.Config(task="torque_minimisation"))
    rows = task.rows(kinematics, reference_at(robot, kinematics, stance))
    assert rows.variable is Variable.TORQUE
    torques = np.random.default_rng(0).normal(size=12)
    np.testing.assert_array_equal(rows.matrix @ torques, torques)
    np.testing.assert_array_equal(rows.lower, np.zeros(12))
    np.testing.assert_array_equal(rows.upper, np.zeros(12))
