"""Jacobians and bias terms against finite differences along a motion with constant generalised velocity."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from quadlab.geometry.rotations import Array, matrix_to_quat
from quadlab.robots.catalogue import robot_config, robot_names
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.state import RobotState

STEP = 1e-5  # [s]


@pytest.fixture(params=robot_names())
def robot(request: pytest.FixtureRequest) -> RobotModel:
    return load_robot(robot_config(request.param))


def moving_state(robot: RobotModel) -> RobotState:
    generator = np.random.default_rng(3)
    quat = generator.normal(size=4)
    return replace(
        robot.nominal_state(),
        position_base_in_world=generator.normal(size=3),
        quat_wxyz=quat / np.linalg.norm(quat),
        joint_positions=robot.nominal_joint_positions + generator.uniform(-0.3, 0.3, 12),
        linear_velocity_base_in_world=generator.normal(size=3),
        angular_velocity_base_in_base=generator.normal(size=3),
        joint_velocities=generator.normal(size=12),
    )


def after(robot: RobotModel, state: RobotState, duration: float) -> Kinematics:
    """Kinematics after moving for ``duration`` with the generalised velocity of ``state``."""
    _, velocity = robot.to_pinocchio(state)
    twist = pin.Motion(velocity[:6])
    pose = pin.SE3(state.rotation_base_to_world, state.position_base_in_world) * pin.exp6(twist * duration)
    moved = replace(
        state,
        position_base_in_world=pose.translation,
        quat_wxyz=matrix_to_quat(pose.rotation),
        linear_velocity_base_in_world=pose.rotation @ twist.linear,
        joint_positions=state.joint_positions + duration * state.joint_velocities,
    )
    return robot.kinematics(moved)


def difference(later: Array, earlier: Array) -> Array:
    return (later - earlier) / (2.0 * STEP)


def test_jacobians_map_to_the_rate_of_their_positions(robot: RobotModel) -> None:
    state = moving_state(robot)
    now, later, earlier = robot.kinematics(state), after(robot, state, STEP), after(robot, state, -STEP)
    u = now.generalized_velocity
    np.testing.assert_allclose(difference(later.com_position, earlier.com_position), now.com_velocity, atol=1e-7)
    np.testing.assert_allclose(now.com_jacobian @ u, now.com_velocity, atol=1e-12)
    np.testing.assert_allclose(difference(later.foot_centers, earlier.foot_centers), now.foot_velocities, atol=1e-7)
    np.testing.assert_allclose(now.foot_jacobians @ u, now.foot_velocities, atol=1e-12)
    base_velocity = np.concatenate([now.base_linear_velocity, now.base_angular_velocity])
    np.testing.assert_allclose(now.base_jacobian @ u, base_velocity, atol=1e-12)


def test_bias_terms_are_the_rate_of_their_jacobians(robot: RobotModel) -> None:
    state = moving_state(robot)
    now, later, earlier = robot.kinematics(state), after(robot, state, STEP), after(robot, state, -STEP)
    u = now.generalized_velocity
    for jacobian, bias in (
        ("com_jacobian", now.com_bias),
        ("base_jacobian", now.base_bias),
        ("foot_jacobians", now.foot_bias),
        ("contact_jacobians", now.contact_bias),
    ):
        rate = difference(getattr(later, jacobian) @ u, getattr(earlier, jacobian) @ u)
        np.testing.assert_allclose(rate, bias, atol=2e-6, err_msg=jacobian)


def test_contact_points_are_below_the_sphere_centres(robot: RobotModel) -> None:
    kinematics = robot.kinematics(moving_state(robot))
    below = kinematics.foot_centers - kinematics.foot_positions
    np.testing.assert_allclose(below, np.tile([0.0, 0.0, robot.foot_radius], (4, 1)), atol=1e-12)


def test_contact_jacobian_is_that_of_a_rolling_sphere(robot: RobotModel) -> None:
    """With all contact points at rest, a sphere's centre moves at radius times its angular velocity."""
    state = moving_state(robot)
    kinematics = robot.kinematics(state)
    rolling = np.linalg.svd(kinematics.contact_jacobians.reshape(12, 18))[2][12:].T
    velocities = kinematics.foot_jacobians @ rolling
    assert np.abs(velocities[:, 2]).max() < 1e-12
    assert np.abs(velocities[:, :2]).max() > 0.1 * robot.foot_radius


def test_kinetic_energy_is_that_of_the_moving_masses(robot: RobotModel) -> None:
    state = moving_state(robot)
    kinematics = robot.kinematics(state)
    u = kinematics.generalized_velocity
    q, v = robot.to_pinocchio(state)
    energy = pin.computeKineticEnergy(robot.pin_model, robot.pin_model.createData(), q, v)
    assert 0.5 * u @ kinematics.mass_matrix @ u == pytest.approx(energy, rel=1e-12)


def test_points_are_those_of_the_whole_kinematics(robot: RobotModel) -> None:
    state = moving_state(robot)
    points, kinematics = robot.points(state), robot.kinematics(state)
    np.testing.assert_allclose(points.com_position, kinematics.com_position, atol=1e-12)
    np.testing.assert_allclose(points.com_velocity, kinematics.com_velocity, atol=1e-12)
    np.testing.assert_allclose(points.foot_positions, kinematics.foot_positions, atol=1e-12)
    velocities = kinematics.contact_jacobians @ kinematics.generalized_velocity
    np.testing.assert_allclose(points.foot_contact_velocities, velocities, atol=1e-12)


def test_kinematics_keep_their_numbers_when_the_next_state_is_computed(robot: RobotModel) -> None:
    first = robot.kinematics(moving_state(robot))
    kept = {name: np.copy(value) for name, value in first._asdict().items()}
    robot.kinematics(robot.nominal_state())
    for name, value in kept.items():
        np.testing.assert_array_equal(getattr(first, name), value, err_msg=name)
