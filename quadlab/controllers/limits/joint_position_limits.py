"""Joint angles within their range (Bellicoso 2016, Eq. 25-27, for the configuration)."""

from typing import Literal

import numpy as np

from quadlab.configuration import Positive, StrictModel, register
from quadlab.controllers.limits.second_order import position_limit
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows
from quadlab.robots.kinematics import JOINTS, VELOCITY_SIZE, Kinematics


@register("task", "joint_position_limits")
class JointPositionLimits:
    """q_min <= q <= q_max."""

    class Config(StrictModel):
        """How early the limits are felt.

        Attributes:
            look_ahead_s: k_t t_s of Eq. (27) in [s].
        """

        task: Literal["joint_position_limits"]
        look_ahead_s: Positive

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return twelve rows in accelerations."""
        lower, upper = reference.joint_position_limits.T
        return position_limit(
            np.eye(VELOCITY_SIZE)[JOINTS],
            np.zeros(len(lower)),
            kinematics.joint_positions,
            kinematics.generalized_velocity[JOINTS],
            (lower, upper),
            self.config.look_ahead_s,
        )
