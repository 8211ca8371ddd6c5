"""The legs seen from the base agree with the kinematics and dynamics of the whole robot."""

from dataclasses import replace

import numpy as np
import pytest
from estimation_cases import robot_named

from quadlab.constants import GRAVITY
from quadlab.estimation.leg_kinematics import LegModel
from quadlab.geometry.rotations import matrix_to_quat, rotation_zyx
from quadlab.robots.kinematics import BASE_ANGULAR, BASE_LINEAR, JOINTS
from quadlab.robots.legs import LEG_COUNT, joints_of
from quadlab.robots.model import RobotModel
from quadlab.robots.sensing import SensorReading
from quadlab.robots.state import RobotState


@pytest.fixture(params=["anymal_b", "hyq"])
def robot(request: pytest.FixtureRequest) -> RobotModel:
    return robot_named(request.param)


def any_state(robot: RobotModel, seed: int) -> RobotState:
    generator = np.random.default_rng(seed)
    return replace(
        robot.nominal_state(),
        quat_wxyz=matrix_to_quat(rotation_zyx(*generator.uniform(-0.5, 0.5, 3))),
        joint_positions=robot.nominal_joint_positions + generator.uniform(-0.2, 0.2, 12),
        linear_velocity_base_in_world=generator.normal(size=3),
        angular_velocity_base_in_base=generator.normal(size=3),
        joint_velocities=generator.normal(size=12),
    )


@pytest.mark.parametrize("seed", range(3))
def test_feet_are_where_the_whole_robot_has_them(robot: RobotModel, seed: int) -> None:
    state = any_state(robot, seed)
    legs, whole = LegModel(robot).kinematics(state.joint_positions, state.joint_velocities), robot.kinematics(state)
    rotation = state.rotation_base_to_world
    expected = (whole.foot_centers - state.position_base_in_world) @ rotation
    np.testing.assert_allclose(legs.foot_centers, expected, atol=1e-12)
    for leg in range(LEG_COUNT):
        joints = np.arange(JOINTS.start, JOINTS.stop)[joints_of(leg)]
        np.testing.assert_allclose(rotation @ legs.jacobians[leg], whole.foot_jacobians[leg][:, joints], atol=1e-12)


def test_spin_is_the_sum_of_the_joints_axes(robot: RobotModel) -> None:
    """With HAA at rest both other joints turn about the same sideways axis."""
    joint_velocities = np.zeros(12)
    joint_velocities[1:3] = [0.7, -0.2]
    upright = np.where(np.arange(12) % 3 == 0, 0.0, robot.nominal_joint_positions)
    spins = LegModel(robot).kinematics(upright, joint_velocities).foot_spins
    np.testing.assert_allclose(np.abs(spins[0]), [0.0, 0.5, 0.0], atol=1e-9)
    np.testing.assert_array_equal(spins[1:], 0.0)


@pytest.mark.parametrize("seed", range(3))
def test_torques_give_back_the_forces_under_the_feet(robot: RobotModel, seed: int) -> None:
    """Any motion without angular acceleration of the base, any forces, the torques that the dynamics ask for."""
    state, generator = any_state(robot, seed), np.random.default_rng(50 + seed)
    whole, rotation = robot.kinematics(state), state.rotation_base_to_world
    forces, acceleration = 100.0 * generator.normal(size=(4, 3)), generator.normal(size=18)
    acceleration[BASE_ANGULAR] = 0.0
    generalized = np.einsum("lij,li->j", whole.foot_jacobians, forces)
    torques = (whole.mass_matrix @ acceleration + whole.nonlinear_effects - generalized)[JOINTS]
    u = whole.generalized_velocity
    specific_force = acceleration[BASE_LINEAR] + np.cross(u[BASE_ANGULAR], u[BASE_LINEAR]) + GRAVITY * rotation[2]
    reading = SensorReading(
        time_s=0.0,
        gyro=state.angular_velocity_base_in_base,
        accelerometer=specific_force,
        joint_positions=state.joint_positions,
        joint_velocities=state.joint_velocities,
        joint_torques=torques,
        foot_forces_in_base=np.zeros((4, 3)),
    )
    model = LegModel(robot)
    legs = model.kinematics(state.joint_positions, state.joint_velocities)
    found = model.foot_forces(reading, legs, acceleration[JOINTS])
    np.testing.assert_allclose(found @ rotation.T, forces, atol=1e-6)
