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

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return twelve rows in torques."""
        limits = self.config.share * reference.torque_limits
        return TaskRows(Variable.TORQUE, _IDENTITY, -limits, limits)
