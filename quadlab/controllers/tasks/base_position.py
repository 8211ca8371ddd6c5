"""Horizontal position of the base (Gehring 2017, Eq. 15)."""

from typing import Literal

from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.control_frame import FramedGains, write_horizontal_rows
from quadlab.controllers.tasks.task import TaskRows, Variable, empty_equation
from quadlab.robots.kinematics import VELOCITY_SIZE, Kinematics


@register("task", "base_position")
class BasePositionTask:
    """J_B,xy u_dot = r_ddot_ref + K_D (r_dot_ref - r_dot) + K_P (r_ref - r) - J_dot u.

    The two axes are those of the world, or heading and lateral of the ground. The height has a task of its own, so that
    its gains can differ as in the paper.
    """

    class Config(FramedGains):
        """Gains of the horizontal base motion."""

        task: Literal["base_position"]

    def __init__(self, config: Config) -> None:
        self.config = config
        self._rows = empty_equation(Variable.ACCELERATION, 2, VELOCITY_SIZE)

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return two rows in accelerations."""
        write_horizontal_rows(
            self.config,
            reference.ground_axes,
            (reference.base_acceleration, reference.base_velocity, reference.base_position),
            (kinematics.base_bias, kinematics.base_linear_velocity, kinematics.base_position),
            kinematics.base_jacobian,
            (self._rows.matrix, self._rows.upper),
        )
        return self._rows
