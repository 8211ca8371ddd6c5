"""Friction pyramids hold exactly the forces that push and do not slip; torque limits hold the drives' torques."""

from dataclasses import replace

import numpy as np
import pytest
from controller_cases import STANCES, reference_at

from quadlab.controllers.limits.friction_cone import FrictionCone
from quadlab.controllers.limits.torque_limits import TorqueLimits
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows, Variable
from quadlab.controllers.tracking.torso import ground_axes
from quadlab.estimation.terrain_plane import TerrainPlane
from quadlab.geometry.rotations import Array
from quadlab.robots.model import RobotModel

FRICTION, FLOOR_SHARE = 0.5, 0.01
SLOPES = ((0.0, 0.0), (0.3, 0.0), (-0.2, 0.4))
slopes = pytest.mark.parametrize("slope", SLOPES, ids=str)


def friction_cone(floor_share: float = FLOOR_SHARE) -> FrictionCone:
    config = FrictionCone.Config(task="friction_cone", friction=FRICTION, minimum_normal_force_share=floor_share)
    return FrictionCone(config)


def reference_on(robot: RobotModel, slope: tuple[float, float], stance: list[int]) -> ControlReference:
    axes = ground_axes(0.7, TerrainPlane((0.0, 0.0), 0.0, slope))
    limits = np.array([0.5, 1.0, 1.5, 2.0]) * robot.mass * 9.81
    exact = reference_at(robot, robot.kinematics(robot.nominal_state()), stance)
    return replace(exact, ground_axes=axes, normal_force_limits=limits)


def friction_rows(robot: RobotModel, reference: ControlReference, floor_share: float = FLOOR_SHARE) -> TaskRows:
    return friction_cone(floor_share).rows(robot.kinematics(robot.nominal_state()), reference)


def satisfied(rows: TaskRows, forces: Array) -> bool:
    values = rows.matrix @ forces.ravel()
    return bool(np.all(values <= rows.upper) and np.all(values >= rows.lower))


@slopes
@pytest.mark.parametrize("stance", STANCES[:-1], ids=str)
def test_rows_hold_exactly_the_forces_of_the_pyramids(
    robot: RobotModel, slope: tuple[float, float], stance: list[int]
) -> None:
    reference = reference_on(robot, slope, stance)
    rows = friction_rows(robot, reference)
    assert rows.variable is Variable.FORCE
    generator = np.random.default_rng(0)
    heading, lateral, normal = reference.ground_axes.T
    verdicts = []
    for _ in range(400):
        limits = reference.normal_force_limits[stance]
        local = np.column_stack([generator.uniform(-1.0, 1.0, (len(stance), 2)), np.ones(len(stance))])
        local[:, :2] *= 1.3 * FRICTION if generator.random() < 0.5 else FRICTION
        normal_forces = generator.uniform(-0.01, 1.1, len(stance)) * limits
        forces = normal_forces[:, None] * (local @ reference.ground_axes.T)
        pushes = (forces @ normal >= FLOOR_SHARE * reference.weight) & (forces @ normal <= limits)
        sticks = np.maximum(np.abs(forces @ heading), np.abs(forces @ lateral)) <= FRICTION * (forces @ normal)
        verdicts.append(satisfied(rows, forces))
        assert verdicts[-1] == bool(np.all(pushes & sticks))
    assert {False, True} == set(verdicts), "the sample must hold forces of both kinds"


@slopes
@pytest.mark.parametrize("corner", [(1, 1), (1, -1), (-1, 1), (-1, -1)])
def test_force_along_an_edge_is_on_two_bounds(
    robot: RobotModel, slope: tuple[float, float], corner: tuple[int, int]
) -> None:
    reference = reference_on(robot, slope, [2])
    rows = friction_rows(robot, reference)
    force = 100.0 * reference.ground_axes @ np.array([FRICTION * corner[0], FRICTION * corner[1], 1.0])
    gaps = (rows.upper - rows.matrix @ force)[:4]
    assert np.sum(np.abs(gaps) < 1e-9) == 2
    assert np.sum(gaps > 1.0) == 2


def test_ramp_below_the_floor_wins_over_the_floor(robot: RobotModel) -> None:
    """A leg whose limit is lower than the least force is not asked for more than its limit."""
    reference = reference_on(robot, (0.0, 0.0), [0, 1, 2, 3])
    rows = friction_rows(robot, replace(reference, normal_force_limits=np.zeros(4)), floor_share=0.2)
    normal_rows = slice(4, None, 5)
    np.testing.assert_array_equal(rows.lower[normal_rows], 0.0)
    np.testing.assert_array_equal(rows.upper[normal_rows], 0.0)


def test_robot_in_the_air_has_no_friction_rows(robot: RobotModel) -> None:
    assert friction_rows(robot, reference_on(robot, (0.0, 0.0), [])).matrix.shape == (0, 0)


@pytest.mark.parametrize("share", [1.0, 0.4])
def test_torque_limits_hold_a_share_of_the_drives_torque(robot: RobotModel, share: float) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    limits = TorqueLimits(TorqueLimits.Config(task="torque_limits", share=share))
    rows = limits.rows(kinematics, reference_at(robot, kinematics))
    assert rows.variable is Variable.TORQUE
    torques = share * robot.torque_limits
    assert satisfied(rows, torques)
    assert satisfied(rows, -torques)
    for joint in range(12):
        too_much = 0.5 * torques
        too_much[joint] = 1.01 * torques[joint]
        assert not satisfied(rows, too_much)
        assert not satisfied(rows, -too_much)
