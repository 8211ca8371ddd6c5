"""The hierarchical controller on a standing robot: balance of forces, exact tracking, the way back to the reference."""

from dataclasses import replace

import numpy as np
import pytest
from controller_cases import (
    controller_config,
    disturbed_state,
    integrated,
    moved_state,
    standing_schedule,
    uniform_plan,
    with_loads,
)

from quadlab.controllers.reduced_dynamics import reduce_dynamics
from quadlab.controllers.telemetry import ControlTelemetry, LegMode
from quadlab.controllers.tracking_controller import build_controller
from quadlab.errors import QuadlabError
from quadlab.geometry.rotations import matrix_to_quat, rotation_2d, rotation_log, rotation_zyx, wrap_angle
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState

STANDING = [0, 1, 2, 3]
GRAVITY_IN_WORLD = np.array([0.0, 0.0, -9.81])  # [m/s^2]


def first_tick(robot: RobotModel, state: RobotState) -> ControlTelemetry:
    """The tick in which a standing controller, started in the nominal stance, first sees ``state``."""
    controller = build_controller(controller_config(), robot)
    controller.start(uniform_plan(robot, standing_schedule()), with_loads(robot, robot.nominal_state()))
    command, telemetry = controller.tick(with_loads(robot, state))
    np.testing.assert_array_equal(command.torques, telemetry.torques_desired)
    return telemetry


def test_forces_carry_the_weight_and_balance_about_the_centre_of_mass(robot: RobotModel) -> None:
    telemetry = first_tick(robot, robot.nominal_state())
    forces = telemetry.contact_forces_desired
    arms = telemetry.foot_positions - telemetry.com_position
    weight = robot.mass * 9.81
    np.testing.assert_allclose(forces.sum(axis=0), [0.0, 0.0, weight], atol=1e-6 * weight)
    np.testing.assert_allclose(np.cross(arms, forces).sum(axis=0), 0.0, atol=1e-6 * weight)
    assert np.all(forces[:, 2] > 0.1 * weight)


def test_rest_at_the_reference_leaves_no_residual(robot: RobotModel) -> None:
    telemetry = first_tick(robot, robot.nominal_state())
    residuals = telemetry.level_residuals
    assert all(residuals[name] < 1e-8 for name in ("torque", "friction", "swing", "torso"))
    assert telemetry.leg_modes == (LegMode.STANCE,) * 4
    assert telemetry.fallbacks == 0
    assert np.all(np.abs(telemetry.torques_desired) <= robot.torque_limits)


def test_forces_are_the_smallest_that_carry_the_robot(robot: RobotModel) -> None:
    """The last level chooses, among all forces that hold the torso, those with the least norm."""
    telemetry = first_tick(robot, robot.nominal_state())
    forces = telemetry.contact_forces_desired
    arms = telemetry.foot_positions - telemetry.com_position
    total_force = np.tile(np.eye(3), 4)
    total_moment = np.concatenate([np.cross(arm, np.eye(3)).T for arm in arms], axis=1)
    smallest = np.linalg.lstsq(np.vstack([total_force, total_moment]), [0, 0, robot.mass * 9.81, 0, 0, 0], rcond=None)[
        0
    ]
    np.testing.assert_allclose(forces.ravel(), smallest, atol=1e-6 * robot.mass)


@pytest.mark.parametrize("seed", range(4))
def test_what_can_be_attained_is_attained(robot: RobotModel, seed: int) -> None:
    """Small disturbances ask for no more than friction and drives give: the torso level is met exactly."""
    state = disturbed_state(robot, seed, size=0.3)
    telemetry = first_tick(robot, state)
    assert all(telemetry.level_residuals[name] < 1e-7 for name in ("torque", "friction", "torso"))
    kinematics = robot.kinematics(state)
    dynamics = reduce_dynamics(kinematics, STANDING)
    com_acceleration = kinematics.com_jacobian @ dynamics.accelerations(telemetry.torques_desired) + kinematics.com_bias
    asked = 60.0 * (telemetry.com_position_reference - telemetry.com_position)[:2] - 16.0 * telemetry.com_velocity[:2]
    np.testing.assert_allclose(com_acceleration[:2], asked, atol=1e-6)
    total_force = telemetry.contact_forces_desired.sum(axis=0)
    np.testing.assert_allclose(total_force / robot.mass, com_acceleration - GRAVITY_IN_WORLD, atol=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_limits_hold_whatever_the_state(robot: RobotModel, seed: int) -> None:
    telemetry = first_tick(robot, disturbed_state(robot, seed, size=4.0))
    assert telemetry.level_residuals["torque"] < 1e-7
    assert telemetry.level_residuals["friction"] < 1e-7
    assert np.all(np.abs(telemetry.torques_desired) <= robot.torque_limits * (1 + 1e-9))
    forces = telemetry.contact_forces_desired
    assert np.all(forces[:, 2] >= 0.0)
    assert np.all(np.abs(forces[:, :2]).max(axis=1) <= 0.7 * forces[:, 2])


@pytest.mark.parametrize("seed", range(2))
def test_disturbed_robot_returns_to_its_reference(robot: RobotModel, seed: int) -> None:
    """Integrated with feet that roll without slip, all errors of the torso vanish."""
    controller = build_controller(controller_config(), robot)
    state = moved_state(disturbed_state(robot, seed, size=0.5), np.array([0.02, -0.01]), 0.05)
    state = _with_feet_at_rest(robot, with_loads(robot, state))
    controller.start(uniform_plan(robot, standing_schedule()), state)
    for _ in range(round(1.2 / controller.period_s)):
        command, telemetry = controller.tick(state)
        dynamics = reduce_dynamics(robot.kinematics(state), STANDING)
        state = integrated(robot, state, dynamics.accelerations(command.torques), controller.period_s)
    error = telemetry.com_position_reference - telemetry.com_position
    np.testing.assert_allclose(error, 0.0, atol=1e-3)
    np.testing.assert_allclose(telemetry.com_velocity, 0.0, atol=1e-3)
    roll, pitch, yaw = telemetry.base_rpy_reference
    measured = rotation_log(state.rotation_base_to_world)
    np.testing.assert_allclose([wrap_angle(a) for a in measured - [roll, pitch, yaw]], 0.0, atol=2e-3)


def _with_feet_at_rest(robot: RobotModel, state: RobotState) -> RobotState:
    kinematics = robot.kinematics(state)
    jacobian = kinematics.contact_jacobians.reshape(12, 18)
    base = kinematics.generalized_velocity[:6]
    joints = -np.linalg.solve(jacobian[:, 6:], jacobian[:, :6] @ base)
    return replace(state, joint_velocities=np.asarray(joints, dtype=np.float64))


@pytest.mark.parametrize("yaw", [0.6, -2.8])
def test_torques_do_not_depend_on_where_the_world_has_its_axes(robot: RobotModel, yaw: float) -> None:
    """Robot and plan turned and shifted together: the same torques."""
    shift = np.array([3.0, -2.0])
    torques = []
    for angle, offset in ((0.0, np.zeros(2)), (yaw, shift)):
        controller = build_controller(controller_config(), robot)
        plan = uniform_plan(robot, standing_schedule(), (0.2, 0.1), (float(offset[0]), float(offset[1])), angle)
        controller.start(plan, moved_state(with_loads(robot, robot.nominal_state()), offset, angle))
        state = with_loads(robot, disturbed_state(robot, 2))
        command, _ = controller.tick(moved_state(state, offset, angle))
        torques.append(command.torques)
    np.testing.assert_allclose(torques[1], torques[0], atol=1e-6)


def test_plan_begins_when_it_is_started(robot: RobotModel) -> None:
    controller = build_controller(controller_config(), robot)
    state = replace(with_loads(robot, robot.nominal_state()), time_s=7.0)
    controller.start(uniform_plan(robot, standing_schedule()), state)
    assert controller.tick(state)[1].plan_time_s == 0.0
    assert controller.tick(replace(state, time_s=7.5))[1].plan_time_s == pytest.approx(0.5)


def test_telemetry_tells_where_plan_and_ground_are(robot: RobotModel) -> None:
    """Pose of the plan and plane of the ground are enough to draw the plan and the ground in the world."""
    controller = build_controller(controller_config(), robot)
    turned = replace(robot.nominal_state(), quat_wxyz=matrix_to_quat(rotation_zyx(0.0, -0.1, 0.05)))
    state = with_loads(robot, moved_state(turned, np.array([0.3, -0.1]), 0.4))
    plan = uniform_plan(robot, standing_schedule())
    controller.start(plan, state)
    for _ in range(20):
        _, telemetry = controller.tick(state)
    pose, (height, *slope) = telemetry.plan_pose_in_world, telemetry.terrain_plane
    assert np.linalg.norm(pose[:2]) > 0.01
    turn = rotation_2d(float(pose[2]))
    np.testing.assert_allclose(telemetry.cop_reference, turn @ plan.cop(0.0) + pose[:2], atol=1e-12)
    com_reference = turn @ plan.com(0.0)[:2] + pose[:2]
    np.testing.assert_allclose(telemetry.com_position_reference[:2], com_reference, atol=1e-12)
    over_com = telemetry.foot_positions[:, :2] - telemetry.com_position[:2]
    np.testing.assert_allclose(height + over_com @ slope, telemetry.foot_positions[:, 2], atol=1e-3)


def test_tick_before_start_is_an_error(robot: RobotModel) -> None:
    with pytest.raises(QuadlabError, match="start"):
        build_controller(controller_config(), robot).tick(robot.nominal_state())
