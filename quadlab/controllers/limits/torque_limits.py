"""Joint torques within what the drives can give (Bellicoso 2016, Eq. 28)."""

from typing import Literal

import numpy as np

from quadlab.configuration import Fraction, StrictModel, register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows, Variable
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import JOINT_COUNT

_IDENTITY = np.eye(JOINT_COUNT)


@register("task", "torque_limits")
class TorqueLimits:
    """-tau_max <= tau <= tau_max."""

    class Config(StrictModel):
        """What part of the drives' torque the controller may use.

        Attributes:
            share: of the robot's torque limits.
        """

        task: Literal["torque_limits"]
        share: Fraction

    def __init__(self, config: Config) -> None:
        self.config = config
        self._rows = TaskRows(Variable.TORQUE, _IDENTITY, np.empty(JOINT_COUNT), np.empty(JOINT_COUNT))

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return twelve rows in torques."""
        np.multiply(self.config.share, reference.torque_limits, out=self._rows.upper)
        np.negative(self._rows.upper, out=self._rows.lower)
        return self._rows
