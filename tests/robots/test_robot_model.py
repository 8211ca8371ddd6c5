"""Order, stance and statics of every robot."""

import numpy as np
import pytest

from quadlab.errors import RobotDescriptionError
from quadlab.robots.catalogue import robot_config, robot_names
from quadlab.robots.model import RobotModel, load_robot

GRAVITY = 9.81  # [m/s^2]


@pytest.fixture(params=robot_names())
def robot(request: pytest.FixtureRequest) -> RobotModel:
    return load_robot(robot_config(request.param))


def test_legs_are_where_their_names_say(robot: RobotModel) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    for points in (kinematics.foot_positions, kinematics.hip_positions):
        assert np.array_equal(np.sign(points[:, 0]), [1, 1, -1, -1])
        assert np.array_equal(np.sign(points[:, 1]), [1, -1, 1, -1])


def test_joints_move_only_their_own_leg(robot: RobotModel) -> None:
    jacobians = robot.kinematics(robot.nominal_state()).foot_jacobians
    for leg in range(4):
        by_leg = np.abs(jacobians[leg][:, 6:]).reshape(3, 4, 3).max(axis=(0, 2))
        assert by_leg[leg] > 0.05
        assert np.all(np.delete(by_leg, leg) == 0.0)


def test_hip_abduction_moves_feet_sideways_and_knees_do_not(robot: RobotModel) -> None:
    jacobians = robot.kinematics(robot.nominal_state()).foot_jacobians
    for leg in range(4):
        abduction, flexion, knee = jacobians[leg][:, 6 + 3 * leg : 9 + 3 * leg].T
        assert abs(abduction[1]) > 0.15
        assert abs(abduction[0]) < 1e-6
        assert abs(flexion[0]) > 0.15
        assert abs(knee[1]) < abs(knee[0])


def test_nominal_stance_is_level_and_within_limits(robot: RobotModel) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    np.testing.assert_allclose(kinematics.foot_positions[:, 2], 0.0, atol=1e-9)
    lower, upper = robot.joint_position_limits.T
    assert np.all(lower < robot.nominal_joint_positions)
    assert np.all(robot.nominal_joint_positions < upper)
    assert robot.nominal_com_height == pytest.approx(kinematics.com_position[2])
    np.testing.assert_allclose(robot.nominal_feet_in_com[:, 1].sum(), 0.0, atol=0.1)


def test_nominal_angle_that_its_joint_does_not_reach_is_refused() -> None:
    """As degrees in the place of radians mostly are."""
    config = robot_config("anymal_b")
    degrees = dict.fromkeys(config.legs, (0.0, 23.0, -46.0))
    with pytest.raises(RobotDescriptionError, match="nominal_joints_rad: LF_HFE at 23 rad is outside its range of -"):
        load_robot(config.model_copy(update={"nominal_joints_rad": degrees}))


def test_centre_of_mass_is_above_the_feet(robot: RobotModel) -> None:
    feet = robot.nominal_feet_in_com
    assert feet[:2, 0].min() > 0.05 > -0.05 > feet[2:, 0].max()
    assert feet[[0, 2], 1].min() > 0.02 > -0.02 > feet[[1, 3], 1].max()


def test_at_rest_gravity_is_the_only_effect(robot: RobotModel) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    np.testing.assert_allclose(kinematics.nonlinear_effects[:3], [0.0, 0.0, robot.mass * GRAVITY], atol=1e-9)
    np.testing.assert_allclose(
        kinematics.nonlinear_effects, kinematics.com_jacobian.T @ [0.0, 0.0, robot.mass * GRAVITY], atol=1e-9
    )


def test_motors_can_carry_the_robot(robot: RobotModel) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    support = np.concatenate([jacobian[:, :6].T for jacobian in kinematics.contact_jacobians], axis=1)
    forces = np.linalg.lstsq(support, kinematics.nonlinear_effects[:6], rcond=None)[0].reshape(4, 3)
    torques = kinematics.nonlinear_effects[6:] - np.einsum("lij,li->j", kinematics.contact_jacobians[:, :, 6:], forces)
    assert np.all(forces[:, 2] > 0.0)
    assert np.all(np.abs(torques) < 0.6 * robot.torque_limits)


def test_mass_matrix_is_symmetric_and_positive(robot: RobotModel) -> None:
    mass_matrix = robot.kinematics(robot.nominal_state()).mass_matrix
    np.testing.assert_allclose(mass_matrix, mass_matrix.T, atol=1e-12)
    assert np.linalg.eigvalsh(mass_matrix)[0] > 0.0
    np.testing.assert_allclose(mass_matrix[:3, :3], robot.mass * np.eye(3), atol=1e-9)
