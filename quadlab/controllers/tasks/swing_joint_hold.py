"""Joints of the legs in the air held by the drives: no acceleration asked of the controller (Gehring 2017, III-C e)."""

from typing import Literal

import numpy as np

from quadlab.configuration import StrictModel, register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows, Variable, equation
from quadlab.robots.kinematics import JOINTS, VELOCITY_SIZE, Kinematics
from quadlab.robots.legs import joints_of


@register("task", "swing_joint_hold")
class SwingJointHoldTask:
    """q_ddot = 0 for the joints of each leg in the air."""

    class Config(StrictModel):
        """It has no parameters."""

        task: Literal["swing_joint_hold"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return three rows in accelerations for each leg in the air."""
        joints = [joint for leg in reference.swing_legs for joint in range(*joints_of(leg).indices(VELOCITY_SIZE))]
        return equation(Variable.ACCELERATION, np.eye(VELOCITY_SIZE)[JOINTS][joints], np.zeros(len(joints)))
