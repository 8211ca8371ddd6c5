"""Projected inverse dynamics: the torques of the reference motion, whatever the contact forces."""

from dataclasses import replace

import numpy as np
import pytest
from controller_cases import disturbed_state, reference_at
from preset_cases import dynamics_residual, near_rest, preset, resolved

from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import JOINTS, Kinematics
from quadlab.robots.model import RobotModel

CONFIG = preset("projected_inverse_dynamics")
STANDING = [0, 1, 2, 3]


def projector(kinematics: Kinematics, stance: list[int]) -> Array:
    """I - J_c^+ J_c, from the singular value decomposition."""
    contact = kinematics.contact_jacobians[stance].reshape(-1, 18)
    _, sizes, directions = np.linalg.svd(contact)
    rank = int(np.sum(sizes > 1e-9 * max(sizes.max(initial=0.0), 1e-9)))
    null: Array = directions[rank:].T @ directions[rank:]
    return null


def test_standing_robot_is_carried(robot: RobotModel) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    resolution = resolved(CONFIG, kinematics, reference_at(robot, kinematics))
    weight = robot.mass * 9.81
    arms = kinematics.foot_positions - kinematics.com_position
    np.testing.assert_allclose(resolution.contact_forces.sum(axis=0), [0.0, 0.0, weight], atol=1e-6 * weight)
    np.testing.assert_allclose(np.cross(arms, resolution.contact_forces).sum(axis=0), 0.0, atol=1e-6 * weight)
    np.testing.assert_allclose(resolution.accelerations, 0.0, atol=1e-9)
    assert np.all(np.abs(resolution.torques) < robot.torque_limits)


@pytest.mark.parametrize("stance", [STANDING, [0, 1, 3]], ids=str)
@pytest.mark.parametrize("seed", range(3))
def test_consistent_reference_is_followed_exactly(robot: RobotModel, stance: list[int], seed: int) -> None:
    """Three or four feet can give any base acceleration: no part of the equations of motion is left over."""
    kinematics, reference = near_rest(robot, stance, seed)
    resolution = resolved(CONFIG, kinematics, reference)
    np.testing.assert_allclose(dynamics_residual(kinematics, resolution), 0.0, atol=1e-6)
    contact = kinematics.contact_jacobians[stance] @ resolution.accelerations + kinematics.contact_bias[stance]
    np.testing.assert_allclose(contact, 0.0, atol=1e-8)
    assert max(resolution.residuals.values()) < 1e-6


@pytest.mark.parametrize("stance", [STANDING, [0, 1, 3], [1, 2]], ids=str)
def test_torques_are_the_smallest_with_the_same_projection(robot: RobotModel, stance: list[int]) -> None:
    """Torques that only squeeze the feet against each other are not used."""
    kinematics, reference = near_rest(robot, stance)
    torques = resolved(CONFIG, kinematics, reference).torques
    projected = projector(kinematics, stance)[:, JOINTS]
    _, sizes, directions = np.linalg.svd(projected)
    idle = directions[int(np.sum(sizes > 1e-8)) :]
    assert len(idle) == max(3 * len(stance) - 6, 0) or len(stance) == 2
    np.testing.assert_allclose(idle @ torques, 0.0, atol=1e-7 * np.abs(torques).max())


def test_robot_in_the_air_has_plain_inverse_dynamics_of_the_joints(robot: RobotModel) -> None:
    kinematics = robot.kinematics(disturbed_state(robot, 3))
    resolution = resolved(CONFIG, kinematics, reference_at(robot, kinematics, []))
    inverse_dynamics = kinematics.mass_matrix @ resolution.accelerations + kinematics.nonlinear_effects
    np.testing.assert_allclose(resolution.torques, inverse_dynamics[JOINTS], atol=1e-9)
    np.testing.assert_array_equal(resolution.contact_forces, 0.0)


@pytest.mark.parametrize("stance", [[0, 1, 3], [1, 2]], ids=str)
def test_feet_in_the_air_get_the_acceleration_that_is_asked(robot: RobotModel, stance: list[int]) -> None:
    kinematics, exact = near_rest(robot, stance)
    legs = exact.swing_legs
    offset, asked = np.array([0.02, -0.01, 0.03]), np.array([0.5, 1.0, -2.0])
    reference = replace(
        exact, foot_positions=exact.foot_positions + offset, foot_accelerations=exact.foot_accelerations + asked
    )
    resolution = resolved(CONFIG, kinematics, reference)
    given = kinematics.foot_jacobians[legs] @ resolution.accelerations + kinematics.foot_bias[legs]
    expected = asked + CONFIG.gains.feet.proportional_per_s2 * offset
    np.testing.assert_allclose(given, np.tile(expected, (len(legs), 1)), atol=1e-8)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_base_is_pulled_towards_its_reference(robot: RobotModel, axis: int) -> None:
    """Feedback is negative: an error in one direction gives an acceleration in that direction."""
    kinematics = robot.kinematics(robot.nominal_state())
    exact = reference_at(robot, kinematics)
    shift = 0.01 * np.eye(3)[axis]
    moved = replace(exact, com_position=exact.com_position + shift[:2], base_height=exact.base_height + float(shift[2]))
    accelerations = resolved(CONFIG, kinematics, moved).accelerations
    gain = (CONFIG.gains.height if axis == 2 else CONFIG.gains.horizontal).proportional_per_s2
    np.testing.assert_allclose(accelerations[:3], gain * shift, atol=1e-9)
