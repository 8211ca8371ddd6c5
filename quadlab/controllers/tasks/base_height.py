"""Height of the base over the ground (Bellicoso 2016, Table I, "main body height")."""

from typing import Literal

import numpy as np

from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.control_frame import NORMAL_ROW, Frame, FramedGains, follow_base_over_ground
from quadlab.controllers.tasks.task import TaskRows, Variable, empty_equation, equation
from quadlab.robots.kinematics import VELOCITY_SIZE, Kinematics


@register("task", "base_height")
class BaseHeightTask:
    """J_B,z u_dot = z_ddot_ref + K_d (z_dot_ref - z_dot) + K_p (z_ref - z) - J_dot u.

    The axis z is the vertical, or the normal of the ground.
    """

    class Config(FramedGains):
        """Gains of the vertical base motion."""

        task: Literal["base_height"]

    def __init__(self, config: Config) -> None:
        self.config = config
        self._rows = empty_equation(Variable.ACCELERATION, 1, VELOCITY_SIZE)

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return one row in accelerations."""
        if self.config.frame is Frame.CONTROL:
            follow_base_over_ground(self.config, kinematics, reference, NORMAL_ROW, self._rows)
            return self._rows
        error = reference.base_height - kinematics.base_position[2]
        velocity_error = reference.base_velocity[2] - kinematics.base_linear_velocity[2]
        commanded = self.config.acceleration(reference.base_acceleration[2], velocity_error, error)
        target = commanded - kinematics.base_bias[2]
        return equation(Variable.ACCELERATION, kinematics.base_jacobian[2:3], np.array([target]))
