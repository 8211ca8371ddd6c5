"""Height of the base over the ground (Bellicoso 2016, Table I, "main body height")."""

from typing import Literal

import numpy as np

from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.control_frame import Frame, FramedGains, climbing_speed
from quadlab.controllers.tasks.task import TaskRows, Variable, equation
from quadlab.robots.kinematics import Kinematics


@register("task", "base_height")
class BaseHeightTask:
    """J_B,z u_dot = z_ddot_ref + K_d (z_dot_ref - z_dot) + K_p (z_ref - z) - J_dot u.

    The axis z is the vertical; in the control frame z_dot_ref counts from the speed at which the ground under the base
    rises, so that a climbing base does not lag behind.
    """

    class Config(FramedGains):
        """Gains of the vertical base motion."""

        task: Literal["base_height"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return one row in accelerations."""
        error = reference.base_height - kinematics.base_position[2]
        velocity_error = reference.base_velocity[2] - kinematics.base_linear_velocity[2]
        if self.config.frame is Frame.CONTROL:
            velocity_error += climbing_speed(reference.ground_axes, kinematics.base_linear_velocity)
        commanded = self.config.acceleration(reference.base_acceleration[2], velocity_error, error)
        target = commanded - kinematics.base_bias[2]
        return equation(Variable.ACCELERATION, kinematics.base_jacobian[2:3], np.array([target]))
