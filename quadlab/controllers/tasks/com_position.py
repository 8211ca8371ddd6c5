"""Centre of mass x and y (Bellicoso 2016, Eq. 17, with the position error as last term)."""

from typing import Literal

from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.gains import TrackingGains, write_tracking_rows
from quadlab.controllers.tasks.task import TaskRows, Variable, empty_equation
from quadlab.robots.kinematics import VELOCITY_SIZE, Kinematics


@register("task", "com_position")
class ComPositionTask:
    """J_com,xy u_dot = c_ddot_ref + K_d (c_dot_ref - c_dot) + K_p (c_ref - c) - J_dot u.

    In world axes and with one gain for both, where the papers use a control frame that leans with the ground: on level
    ground that is the same.
    """

    class Config(TrackingGains):
        """Gains of the horizontal CoM motion."""

        task: Literal["com_position"]

    def __init__(self, config: Config) -> None:
        self.config = config
        self._rows = empty_equation(Variable.ACCELERATION, 2, VELOCITY_SIZE)

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return two rows in accelerations."""
        write_tracking_rows(
            self.config.proportional_per_s2,
            self.config.derivative_per_s,
            reference.com_acceleration,
            (reference.com_velocity, kinematics.com_velocity),
            (reference.com_position, kinematics.com_position),
            kinematics.com_bias,
            kinematics.com_jacobian,
            (self._rows.matrix, self._rows.upper),
        )
        return self._rows
