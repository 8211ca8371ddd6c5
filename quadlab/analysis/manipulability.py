"""How well the legs move their feet over a logged motion: the measure of Bellicoso 2016, Eq. (22)."""

from dataclasses import replace

import numpy as np
import pandas as pd

from quadlab.controllers.tasks.manipulability_height import leg_manipulability
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import JOINTS
from quadlab.robots.legs import JOINT_NAMES, LEG_COUNT, joints_of
from quadlab.robots.model import RobotModel


def mean_manipulability(robot: RobotModel, trace: pd.DataFrame) -> Array:
    """Return the mean over the legs of m = sqrt(det(J J^T)) at each row of a trace, (n,) in [m^3].

    Args:
        robot: that moved.
        trace: with the columns ``state.joint_position_<joint>``.
    """
    columns = [f"state.joint_position_{joint}" for joint in JOINT_NAMES]
    return np.array([_mean(robot, joints) for joints in trace[columns].to_numpy(float)])


def _mean(robot: RobotModel, joint_positions: Array) -> float:
    kinematics = robot.kinematics(replace(robot.nominal_state(), joint_positions=joint_positions))
    jacobians = kinematics.foot_jacobians[:, :, JOINTS]
    return float(np.mean([leg_manipulability(jacobians[leg][:, joints_of(leg)]) for leg in range(LEG_COUNT)]))
