"""Horizontal position of the base (Gehring 2017, Eq. 15)."""

from typing import Literal

import numpy as np

from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.gains import TrackingGains, tracking_target
from quadlab.controllers.tasks.task import TaskRows, Variable, equation
from quadlab.robots.kinematics import Kinematics


@register("task", "base_position")
class BasePositionTask:
    """J_B,xy u_dot = r_ddot_ref + K_D (r_dot_ref - r_dot) + K_P (r_ref - r) - J_dot u.

    The height has a task of its own, so that its gains can differ as they do in the paper's control frame.
    """

    class Config(TrackingGains):
        """Gains of the horizontal base motion."""

        task: Literal["base_position"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return two rows in accelerations."""
        target = np.empty(2)
        tracking_target(
            self.config.proportional_per_s2,
            self.config.derivative_per_s,
            reference.com_acceleration,
            (reference.com_velocity, kinematics.base_linear_velocity),
            (reference.base_position, kinematics.base_position),
            kinematics.base_bias,
            target,
        )
        return equation(Variable.ACCELERATION, kinematics.base_jacobian[:2], target)
