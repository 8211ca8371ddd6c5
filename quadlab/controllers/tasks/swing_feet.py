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
        target = self.config.acceleration(  # of all feet; standing ones are NaN and left out
            reference.foot_accelerations,
            reference.foot_velocities - kinematics.foot_velocities,
            reference.foot_positions - kinematics.foot_positions,
        )
        swing = ~reference.stance
        matrix = kinematics.foot_jacobians[swing].reshape(-1, VELOCITY_SIZE)
        return equation(Variable.ACCELERATION, matrix, (target - kinematics.foot_bias)[swing].ravel())
