"""Joint torques within what the drives can give (Bellicoso 2016, Eq. 28)."""

from typing import Literal

import numpy as np

from quadlab.configuration import Fraction, StrictModel, register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows, Variable, empty_rows
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
        self._limits = b""
        self._rows = empty_rows(Variable.TORQUE, JOINT_COUNT, JOINT_COUNT)

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return twelve rows in torques."""
        limits = reference.torque_limits.tobytes()
        if limits != self._limits:  # another robot; else the rows are those of the tick before
            self._limits = limits
            upper = self.config.share * reference.torque_limits
            self._rows = TaskRows(Variable.TORQUE, _IDENTITY, -upper, upper)
        return self._rows
