"""Drives act at every physics step, on top of the torques, within the torque limits."""

import numpy as np
import pytest

from quadlab.robots.catalogue import robot_config
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.state import JointCommand, JointDrive
from quadlab.simulation.simulator import Simulator
from quadlab.trials.compose import compose_trial

PERIOD = 2.5e-3  # [s]


@pytest.fixture(scope="module")
def robot() -> RobotModel:
    return load_robot(robot_config("anymal_b"))


def simulator_of(robot: RobotModel) -> Simulator:
    config = compose_trial(["robot=anymal_b"])
    return Simulator(robot, config.scenario, config.simulation, config.seed)


def drive_at(positions: np.ndarray, proportional: float, derivative: float) -> JointDrive:
    return JointDrive(positions, np.zeros(12), np.zeros(12), proportional, derivative)


def sagging(robot: RobotModel, drive: JointDrive | None) -> float:
    """How far the base has come down after 0.3 s without feed-forward torques, in [m]."""
    simulator = simulator_of(robot)
    height = simulator.read().position_base_in_world[2]
    for _ in range(120):
        simulator.advance(JointCommand(np.zeros(12), drive), PERIOD)
    return float(height - simulator.read().position_base_in_world[2])


def test_stiff_drives_hold_a_robot_that_falls_without_them(robot: RobotModel) -> None:
    held = drive_at(robot.nominal_joint_positions, 800.0, 8.0)
    assert sagging(robot, held) < 0.03
    assert sagging(robot, None) > 0.1


def test_drive_without_gains_changes_nothing(robot: RobotModel) -> None:
    assert sagging(robot, drive_at(np.zeros(12), 0.0, 0.0)) == sagging(robot, None)


def test_sum_of_torques_and_drives_is_clipped(robot: RobotModel) -> None:
    simulator = simulator_of(robot)
    far = drive_at(robot.nominal_joint_positions + 10.0, 1e4, 0.0)
    simulator.advance(JointCommand(-robot.torque_limits, far), PERIOD)
    np.testing.assert_array_equal(simulator.applied_torques, robot.torque_limits)


def test_drives_are_faster_than_the_controller(robot: RobotModel) -> None:
    """Within one control period the torque follows the joints from step to step."""
    simulator = simulator_of(robot)
    for _ in range(20):
        simulator.advance(JointCommand(np.zeros(12)), PERIOD)
    state = simulator.read()
    drive = drive_at(state.joint_positions, 400.0, 8.0)
    simulator.advance(JointCommand(np.zeros(12), drive), PERIOD)
    at_first = drive.torques(0.0, state.joint_positions, state.joint_velocities)
    assert np.abs(simulator.applied_torques - at_first).max() > 0.1
