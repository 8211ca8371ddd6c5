"""Centre of mass x and y (Bellicoso 2016, Eq. 17, with the position error as last term)."""

from typing import Literal

import numpy as np

from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.gains import TrackingGains, tracking_target
from quadlab.controllers.tasks.task import TaskRows, Variable, equation
from quadlab.robots.kinematics import Kinematics


@register("task", "com_position")
class ComPositionTask:
    """J_com,xy u_dot = c_ddot_ref + K_d (c_dot_ref - c_dot) + K_p (c_ref - c) - J_dot u."""

    class Config(TrackingGains):
        """Gains of the horizontal CoM motion."""

        task: Literal["com_position"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return two rows in accelerations."""
        target = np.empty(2)
        tracking_target(
            self.config.proportional_per_s2,
            self.config.derivative_per_s,
            reference.com_acceleration,
            (reference.com_velocity, kinematics.com_velocity),
            (reference.com_position, kinematics.com_position),
            kinematics.com_bias,
            target,
        )
        return equation(Variable.ACCELERATION, kinematics.com_jacobian[:2], target)
