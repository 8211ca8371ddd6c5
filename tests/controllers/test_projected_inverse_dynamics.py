"""Projected inverse dynamics: the torques of the reference motion, whatever the contact forces."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from controller_cases import disturbed_state, reference_at
from preset_cases import dynamics_residual, near_rest, preset, resolved

from quadlab.controllers.reference import ControlReference
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import BASE, JOINTS, Kinematics
from quadlab.robots.model import RobotModel

CONFIG = preset("projected_inverse_dynamics")
PRINTED = preset("projected_inverse_dynamics", "redundancy=torques")
BOTH = pytest.mark.parametrize("config", [CONFIG, PRINTED], ids=["forces", "torques"])
STANDING = [0, 1, 2, 3]


def asked_for_more(reference: ControlReference, seed: int) -> ControlReference:
    """``reference`` with errors of the base and accelerations of CoM and feet in the air."""
    generator = np.random.default_rng(seed)
    return replace(
        reference,
        com_position=reference.com_position + generator.uniform(-0.02, 0.02, 2),
        com_acceleration=generator.uniform(-1.0, 1.0, 2),
        base_height=reference.base_height + 0.01,
        base_velocity=reference.base_velocity + generator.uniform(-0.1, 0.1, 3),
        base_acceleration=generator.uniform(-1.0, 1.0, 3),
        base_angular_acceleration=generator.uniform(-1.0, 1.0, 3),
        base_angular_velocity=generator.uniform(-0.1, 0.1, 3),
        foot_accelerations=reference.foot_accelerations + generator.uniform(-10.0, 10.0, (4, 3)),
    )


def task_accelerations(kinematics: Kinematics, accelerations: Array) -> Array:
    """Accelerations of CoM x and y, of the base's height and of its orientation, (6,)."""
    com = kinematics.com_jacobian @ accelerations + kinematics.com_bias
    base = kinematics.base_jacobian @ accelerations + kinematics.base_bias
    return np.concatenate([com[:2], base[2:]])


def asked_of_base(kinematics: Kinematics, reference: ControlReference) -> Array:
    """What ``task_accelerations`` shall be by the gains, for a base that is turned as it shall be, (6,)."""
    gains = CONFIG.gains
    horizontal = gains.horizontal.acceleration(
        reference.com_acceleration,
        reference.com_velocity - kinematics.com_velocity[:2],
        reference.com_position - kinematics.com_position[:2],
    )
    height = gains.height.acceleration(
        reference.base_acceleration[2:],
        reference.base_velocity[2:] - kinematics.base_linear_velocity[2:],
        np.array([reference.base_height - kinematics.base_position[2]]),
    )
    turn = gains.orientation.acceleration(
        reference.base_angular_acceleration,
        reference.base_angular_velocity - kinematics.base_angular_velocity,
        np.zeros(3),
    )
    return np.concatenate([horizontal, height, turn])


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


@BOTH
@pytest.mark.parametrize("stance", [STANDING, [0, 1, 3], [1, 2], [0, 3]], ids=str)
@pytest.mark.parametrize("seed", range(3))
def test_torques_give_the_accelerations_that_are_announced(
    robot: RobotModel, config: Any, stance: list[int], seed: int
) -> None:
    """No part of the equations of motion is left over, also where two feet cannot give what is asked."""
    kinematics, exact = near_rest(robot, stance, seed)
    resolution = resolved(config, kinematics, asked_for_more(exact, seed))
    np.testing.assert_allclose(dynamics_residual(kinematics, resolution), 0.0, atol=1e-6)
    contact = kinematics.contact_jacobians[stance] @ resolution.accelerations + kinematics.contact_bias[stance]
    np.testing.assert_allclose(contact, 0.0, atol=1e-8)
    assert max(resolution.residuals.values()) < 1e-6


@pytest.mark.parametrize("stance", [STANDING, [0, 1, 3]], ids=str)
@pytest.mark.parametrize("seed", range(3))
def test_three_feet_give_com_and_base_what_is_asked(robot: RobotModel, stance: list[int], seed: int) -> None:
    """The CoM itself, also while a heavy leg swings, if the CoP stays between the feet."""
    kinematics, exact = near_rest(robot, stance, seed)
    off_centre = kinematics.com_position - kinematics.foot_positions[stance].mean(axis=0)
    balanced = 9.81 / off_centre[2] * off_centre[:2]
    reference = replace(asked_for_more(exact, seed), com_position=exact.com_position, com_acceleration=balanced)
    given = task_accelerations(kinematics, resolved(CONFIG, kinematics, reference).accelerations)
    np.testing.assert_allclose(given, asked_of_base(kinematics, reference), atol=1e-8)


@pytest.mark.parametrize("stance", [[1, 2], [0, 3]], ids=str)
def test_two_feet_give_the_nearest_to_what_is_asked(robot: RobotModel, stance: list[int]) -> None:
    """What is missed stands at right angles to all that the feet can give."""
    kinematics, exact = near_rest(robot, stance)
    given, asked = [], []
    for seed in range(7):
        reference = replace(asked_for_more(exact, seed), foot_accelerations=exact.foot_accelerations)
        given.append(task_accelerations(kinematics, resolved(CONFIG, kinematics, reference).accelerations))
        asked.append(asked_of_base(kinematics, reference))
    missed, differences = np.array(asked) - given, np.diff(given, axis=0)
    assert np.linalg.norm(missed, axis=1).min() > 0.01
    assert np.linalg.matrix_rank(differences, tol=1e-6) == 5
    np.testing.assert_allclose(missed @ differences.T, 0.0, atol=1e-6)


@BOTH
@pytest.mark.parametrize("stance", [STANDING, [0, 1, 3], [1, 2]], ids=str)
@pytest.mark.parametrize("direction", range(8))
def test_feet_do_not_pull(robot: RobotModel, config: Any, stance: list[int], direction: int) -> None:
    """However far out the CoP would have to be; the torques still give what is announced."""
    kinematics, exact = near_rest(robot, stance)
    angle = direction * np.pi / 4.0
    asked = 6.0 * np.array([np.cos(angle), np.sin(angle)])
    resolution = resolved(config, kinematics, replace(exact, com_acceleration=asked))
    assert resolution.contact_forces[:, 2].min() >= 0.0
    np.testing.assert_allclose(dynamics_residual(kinematics, resolution), 0.0, atol=1e-6)


@pytest.mark.parametrize("stance", [STANDING, [0, 1, 3], [1, 2]], ids=str)
def test_printed_torques_are_the_smallest_with_the_same_projection(robot: RobotModel, stance: list[int]) -> None:
    """Torques that only squeeze the feet against each other are not used."""
    kinematics, reference = near_rest(robot, stance)
    torques = resolved(PRINTED, kinematics, reference).torques
    projected = projector(kinematics, stance)[:, JOINTS]
    _, sizes, directions = np.linalg.svd(projected)
    idle = directions[int(np.sum(sizes > 1e-8)) :]
    assert len(idle) == max(3 * len(stance) - 6, 0) or len(stance) == 2
    np.testing.assert_allclose(idle @ torques, 0.0, atol=1e-7 * np.abs(torques).max())


@pytest.mark.parametrize("stance", [STANDING, [0, 1, 3], [1, 2]], ids=str)
def test_forces_are_the_smallest_that_carry_the_same_motion(robot: RobotModel, stance: list[int]) -> None:
    """Forces that only squeeze the feet against each other are not used, and the motion does not depend on it."""
    kinematics, reference = near_rest(robot, stance)
    least, printed = (resolved(config, kinematics, reference) for config in (CONFIG, PRINTED))
    on_base = kinematics.contact_jacobians[stance].reshape(-1, 18)[:, BASE].T
    _, sizes, directions = np.linalg.svd(on_base)
    squeezing = directions[int(np.sum(sizes > 1e-8)) :]
    assert len(squeezing) == {4: 6, 3: 3, 2: 1}[len(stance)]
    np.testing.assert_allclose(squeezing @ least.contact_forces[stance].ravel(), 0.0, atol=1e-6)
    assert np.linalg.norm(least.contact_forces) < np.linalg.norm(printed.contact_forces)
    np.testing.assert_allclose(least.accelerations, printed.accelerations)
    same = projector(kinematics, stance)[:, JOINTS] @ (least.torques - printed.torques)
    np.testing.assert_allclose(same, 0.0, atol=1e-6)


def test_robot_in_the_air_has_plain_inverse_dynamics_of_the_joints(robot: RobotModel) -> None:
    kinematics = robot.kinematics(disturbed_state(robot, 3))
    resolution = resolved(CONFIG, kinematics, reference_at(robot, kinematics, []))
    inverse_dynamics = kinematics.mass_matrix @ resolution.accelerations + kinematics.nonlinear_effects
    np.testing.assert_allclose(resolution.torques, inverse_dynamics[JOINTS], atol=1e-9)
    np.testing.assert_array_equal(resolution.contact_forces, 0.0)
    com = kinematics.com_jacobian @ resolution.accelerations + kinematics.com_bias
    legs = robot.mass * com[2] + robot.mass * 9.81
    np.testing.assert_allclose([*com[:2], legs], 0.0, atol=1e-6)


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
    accelerations = task_accelerations(kinematics, resolved(CONFIG, kinematics, moved).accelerations)
    gain = (CONFIG.gains.height if axis == 2 else CONFIG.gains.horizontal).proportional_per_s2
    np.testing.assert_allclose(accelerations[:3], gain * shift, atol=1e-9)
