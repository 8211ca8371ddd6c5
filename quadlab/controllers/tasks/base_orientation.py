"""Orientation of the base, as yaw and as roll and pitch (Bellicoso 2016, Eq. 18, with three rotational rows)."""

from typing import Literal

from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.gains import TrackingGains
from quadlab.controllers.tasks.task import TaskRows, Variable, equation
from quadlab.geometry.rotations import Array, rotation_2d, rotation_log, yaw_of
from quadlab.robots.kinematics import Kinematics


def _angular_target(gains: TrackingGains, kinematics: Kinematics, reference: ControlReference) -> Array:
    """Return what J_omega u_dot shall be in world axes, (3,) in [rad/s^2]; the error is R_ref boxminus R."""
    error = rotation_log(reference.base_rotation @ kinematics.base_rotation.T)
    target = gains.acceleration(0.0, reference.base_angular_velocity - kinematics.base_angular_velocity, error)
    return target - kinematics.base_bias[3:]


@register("task", "base_yaw")
class BaseYawTask:
    """Rotation of the base about the vertical."""

    class Config(TrackingGains):
        """Gains of the yaw motion."""

        task: Literal["base_yaw"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return one row in accelerations."""
        target = _angular_target(self.config, kinematics, reference)
        return equation(Variable.ACCELERATION, kinematics.base_jacobian[5:], target[2:])


@register("task", "base_roll_pitch")
class BaseRollPitchTask:
    """Rotation of the base about the two horizontal axes of its heading frame."""

    class Config(TrackingGains):
        """Gains of the roll and pitch motion."""

        task: Literal["base_roll_pitch"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return two rows in accelerations."""
        target = _angular_target(self.config, kinematics, reference)
        to_heading = rotation_2d(-yaw_of(kinematics.base_rotation))
        return equation(Variable.ACCELERATION, to_heading @ kinematics.base_jacobian[3:5], to_heading @ target[:2])
