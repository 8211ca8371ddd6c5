"""Orientation of the base, as yaw and as roll and pitch (Bellicoso 2016, Eq. 18, with three rotational rows)."""

from typing import Literal

from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.gains import TrackingGains
from quadlab.controllers.tasks.task import TaskRows, Variable, equation
from quadlab.geometry.rotations import rotation_log, rotation_z, yaw_of
from quadlab.robots.kinematics import Kinematics


def _rotational_rows(gains: TrackingGains, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
    """Return roll, pitch and yaw rows in the heading frame; the error is R_ref boxminus R."""
    error = rotation_log(reference.base_rotation @ kinematics.base_rotation.T)
    target = gains.acceleration(0.0, reference.base_angular_velocity - kinematics.base_angular_velocity, error)
    world_to_heading = rotation_z(-yaw_of(kinematics.base_rotation))
    return equation(
        Variable.ACCELERATION,
        world_to_heading @ kinematics.base_jacobian[3:],
        world_to_heading @ (target - kinematics.base_bias[3:]),
    )


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
        rows = _rotational_rows(self.config, kinematics, reference)
        return equation(rows.variable, rows.matrix[2:], rows.upper[2:])


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
        rows = _rotational_rows(self.config, kinematics, reference)
        return equation(rows.variable, rows.matrix[:2], rows.upper[:2])
