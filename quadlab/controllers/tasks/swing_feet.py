"""Motion of the feet in the air (Bellicoso 2016, Eq. 19)."""

from typing import Literal

from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.gains import TrackingGains
from quadlab.controllers.tasks.task import TaskRows, Variable, equation
from quadlab.robots.kinematics import VELOCITY_SIZE, Kinematics


@register("task", "swing_feet")
class SwingFeetTask:
    """J_F u_dot = r_ddot_ref + K_d (r_dot_ref - r_dot) + K_p (r_ref - r) - J_dot u for each foot in the air."""

    class Config(TrackingGains):
        """Gains of the foot motion."""

        task: Literal["swing_feet"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return three rows in accelerations for each leg in the air."""
        legs = reference.swing_legs
        target = self.config.acceleration(
            reference.foot_accelerations[legs],
            reference.foot_velocities[legs] - kinematics.foot_velocities[legs],
            reference.foot_positions[legs] - kinematics.foot_positions[legs],
        )
        matrix = kinematics.foot_jacobians[legs].reshape(3 * len(legs), VELOCITY_SIZE)
        return equation(Variable.ACCELERATION, matrix, (target - kinematics.foot_bias[legs]).ravel())
