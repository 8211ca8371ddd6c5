"""How well the legs of logged motions move their feet."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from quadlab.analysis.manipulability import mean_manipulability
from quadlab.geometry.rotations import Array
from quadlab.robots.catalogue import robot_config
from quadlab.robots.legs import JOINT_COUNT, JOINT_NAMES, LEG_COUNT, joints_of
from quadlab.robots.model import RobotModel, load_robot

STEP = 1e-6  # [rad]


def feet(robot: RobotModel, joints: Array) -> Array:
    return robot.kinematics(replace(robot.nominal_state(), joint_positions=joints)).foot_positions


def test_it_is_the_volume_that_unit_steps_of_the_joints_sweep_with_the_feet() -> None:
    robot = load_robot(robot_config("anymal_b"))
    motion = robot.nominal_joint_positions + np.random.default_rng(0).uniform(-0.3, 0.3, (3, JOINT_COUNT))
    trace = pd.DataFrame(motion, columns=[f"state.joint_position_{joint}" for joint in JOINT_NAMES])
    for joints, measure in zip(motion, mean_manipulability(robot, trace), strict=True):
        moved = [(feet(robot, joints + step) - feet(robot, joints - step)) / (2.0 * STEP) for step in steps()]
        sides = np.array(moved)  # joint, leg, axis
        volumes = [abs(np.linalg.det(sides[joints_of(leg), leg])) for leg in range(LEG_COUNT)]
        assert measure == pytest.approx(np.mean(volumes), rel=1e-6)


def steps() -> Array:
    return STEP * np.eye(JOINT_COUNT)
