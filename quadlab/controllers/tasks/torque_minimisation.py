"""Small joint torques, for energy (Bellicoso 2016, Eq. 20)."""

from typing import Literal

import numpy as np

from quadlab.configuration import StrictModel, register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows, Variable, equation
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import JOINT_COUNT

_ROWS = equation(Variable.TORQUE, np.eye(JOINT_COUNT), np.zeros(JOINT_COUNT))


@register("task", "torque_minimisation")
class TorqueMinimisationTask:
    """tau = 0 as far as higher priorities leave it free."""

    class Config(StrictModel):
        """It has no parameters."""

        task: Literal["torque_minimisation"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return twelve rows in torques."""
        return _ROWS
