"""Drives hold the motion that the controller expects, and take the feet in the air to their references."""

from dataclasses import replace

import numpy as np
import pytest
from controller_cases import controller_config, disturbed_state, integrated, reference_at
from preset_cases import near_rest, preset, resolved

from quadlab.controllers.controller_config import JointPdConfig
from quadlab.controllers.joint_reference import damped_inverse, driven_command, joint_drive
from quadlab.controllers.resolver import Resolution
from quadlab.robots.legs import joints_of
from quadlab.robots.model import RobotModel
from quadlab.robots.state import JointDrive

PD = JointPdConfig(proportional_nm_per_rad=50.0, derivative_nms_per_rad=2.0)
PERIOD = 2.5e-3  # [s]


def still(accelerations: np.ndarray) -> Resolution:
    return Resolution(np.zeros(12), accelerations, np.zeros((4, 3)), {}, 0, solved=True)


def test_drive_is_silent_on_the_motion_that_it_holds() -> None:
    generator = np.random.default_rng(0)
    positions, velocities, accelerations = generator.normal(size=(3, 12))
    drive = JointDrive(positions, velocities, accelerations, 50.0, 2.0)
    for elapsed in (0.0, 0.001, 0.3):
        later = positions + velocities * elapsed + 0.5 * accelerations * elapsed**2
        np.testing.assert_allclose(drive.torques(elapsed, later, velocities + accelerations * elapsed), 0.0, atol=1e-12)


def test_drive_pulls_back_with_its_gains() -> None:
    """Ahead of the motion the torque is negative: K_p (q_ref - q) + K_d (q_dot_ref - q_dot)."""
    drive = JointDrive(np.zeros(12), np.zeros(12), np.zeros(12), 50.0, 2.0)
    np.testing.assert_allclose(drive.torques(0.0, np.full(12, 0.1), np.zeros(12)), -5.0)
    np.testing.assert_allclose(drive.torques(0.0, np.zeros(12), np.full(12, 0.1)), -0.2)


@pytest.mark.parametrize("seed", range(3))
def test_standing_legs_are_held_on_the_expected_motion(robot: RobotModel, seed: int) -> None:
    """A robot that moves as the controller expects feels no correction at any time of the control period."""
    state = disturbed_state(robot, seed)
    kinematics = robot.kinematics(state)
    accelerations = np.random.default_rng(seed).normal(size=18)
    drive = joint_drive(PD, kinematics, reference_at(robot, kinematics), still(accelerations))
    for elapsed in (0.0, 0.5 * PERIOD, PERIOD):
        later = integrated(robot, state, accelerations, elapsed)
        torques = drive.torques(elapsed, later.joint_positions, later.joint_velocities)
        np.testing.assert_allclose(torques, 0.0, atol=1e-10)


@pytest.mark.parametrize("leg", range(4))
def test_feet_in_the_air_are_taken_towards_their_references(robot: RobotModel, leg: int) -> None:
    """Joints at the drive's positions bring the foot closer; the joints of standing legs stay where they are."""
    state = disturbed_state(robot, 1)
    kinematics = robot.kinematics(state)
    stance = [other for other in range(4) if other != leg]
    exact = reference_at(robot, kinematics, stance)
    offset, speed = np.array([0.01, -0.005, 0.01]), np.array([0.1, 0.2, -0.1])
    reference = replace(
        exact, foot_positions=exact.foot_positions + offset, foot_velocities=exact.foot_velocities + speed
    )
    drive = joint_drive(PD, kinematics, reference, still(np.ones(18)))
    moved = robot.kinematics(replace(state, joint_positions=drive.positions, joint_velocities=drive.velocities))
    error = reference.foot_positions[leg] - moved.foot_positions[leg]
    assert np.linalg.norm(error) < 0.1 * np.linalg.norm(offset)
    standing = np.delete(np.arange(12), joints_of(leg))
    np.testing.assert_array_equal(drive.positions[standing], state.joint_positions[standing])
    np.testing.assert_array_equal(drive.accelerations[joints_of(leg)], 0.0)
    np.testing.assert_array_equal(drive.accelerations[standing], 1.0)
    foot_speed = (
        kinematics.foot_jacobians[leg]
        @ robot.kinematics(replace(state, joint_velocities=drive.velocities)).generalized_velocity
    )
    np.testing.assert_allclose(foot_speed - kinematics.foot_velocities[leg], speed, atol=0.02)


def test_stretched_knee_does_not_make_the_joints_jump(robot: RobotModel) -> None:
    """At the singularity the inverse stays bounded by 1 / (2 damping), however far the reference is."""
    state = robot.nominal_state()
    joints = state.joint_positions.copy()
    joints[1::3] = joints[2::3] = 0.0
    kinematics = robot.kinematics(replace(state, joint_positions=joints))
    inverse = damped_inverse(kinematics.foot_jacobians[0][:, 6:9])
    assert np.linalg.norm(inverse, 2) <= 1.0 / (2.0 * 0.02) + 1e-9
    exact = reference_at(robot, kinematics, [1, 2, 3])
    far = replace(exact, foot_positions=exact.foot_positions + np.array([0.0, 0.0, -5.0]))
    drive = joint_drive(PD, kinematics, far, still(np.zeros(18)))
    assert np.abs(drive.positions - joints).max() <= 0.2


def test_no_drive_without_gains(robot: RobotModel) -> None:
    assert controller_config().joint_pd is None
    config = preset("gehring2017")
    kinematics, reference = near_rest(robot, [0, 1, 3])
    drive = joint_drive(config.joint_pd, kinematics, reference, resolved(config, kinematics, reference))
    assert (drive.proportional, drive.derivative) == (
        config.joint_pd.proportional_nm_per_rad,
        config.joint_pd.derivative_nms_per_rad,
    )


def test_legs_in_the_air_that_the_drives_hold_are_not_bent_for_the_base(robot: RobotModel) -> None:
    """On two feet the base is turned by swinging the other legs; held, these get the torques of q_ddot = 0."""
    config = preset("gehring2017")
    kinematics, still_base = near_rest(robot, [0, 3])
    reference = replace(still_base, base_angular_acceleration=np.array([5.0, 5.0, 0.0]))
    solved = resolved(config, kinematics, reference)
    air, standing = np.r_[joints_of(1), joints_of(2)], np.r_[joints_of(0), joints_of(3)]
    assert np.abs(solved.accelerations[6:][air]).max() > 10.0
    torques = driven_command(config.joint_pd, kinematics, reference, solved).torques
    held = solved.accelerations.copy()
    held[6 + air] = 0.0
    motion = kinematics.mass_matrix @ held + kinematics.nonlinear_effects
    np.testing.assert_allclose(torques[air], motion[6:][air], atol=1e-9)
    np.testing.assert_array_equal(torques[standing], solved.torques[standing])


def test_drives_correct_the_solved_torques_where_nothing_else_is_said(robot: RobotModel) -> None:
    config = preset("projected_inverse_dynamics")
    kinematics, reference = near_rest(robot, [0, 3])
    solved = resolved(config, kinematics, reference)
    np.testing.assert_array_equal(
        driven_command(config.joint_pd, kinematics, reference, solved).torques, solved.torques
    )
