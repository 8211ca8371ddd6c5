"""The state of a robot, as the simulator knows it or an estimator believes it."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadlab.geometry.rotations import Array, quat_to_matrix


@dataclass(frozen=True)
class RobotState:
    """Pose and velocity of base and joints, and the forces under the feet, at one time.

    Attributes:
        time_s: time since the start of the trial in [s].
        position_base_in_world: base frame origin, (3,) in [m].
        quat_wxyz: unit quaternion that turns base components into world components, (4,).
        joint_positions: (12,) in [rad], order ``JOINT_NAMES``.
        linear_velocity_base_in_world: velocity of the base origin in world components, (3,) in [m/s].
        angular_velocity_base_in_base: (3,) in [rad/s].
        joint_velocities: (12,) in [rad/s].
        foot_forces_in_world: force of the ground on each foot, (4, 3) in [N], order ``LEGS``.
    """

    time_s: float
    position_base_in_world: Array
    quat_wxyz: Array
    joint_positions: Array
    linear_velocity_base_in_world: Array
    angular_velocity_base_in_base: Array
    joint_velocities: Array
    foot_forces_in_world: Array

    @cached_property
    def rotation_base_to_world(self) -> Array:
        """Rotation matrix of the base, (3, 3)."""
        return quat_to_matrix(self.quat_wxyz)

    def is_finite(self) -> bool:
        """Return whether every number of the state is finite."""
        parts = (
            self.position_base_in_world,
            self.quat_wxyz,
            self.joint_positions,
            self.linear_velocity_base_in_world,
            self.angular_velocity_base_in_base,
            self.joint_velocities,
        )
        return all_finite(np.concatenate(parts))


def all_finite(values: Array) -> bool:
    """Return whether every number in ``values``, (n,), is finite."""
    return math.isfinite(float(values @ values)) or bool(np.isfinite(values).all())


@dataclass(frozen=True)
class JointDrive:
    """A PD law that the drives close faster than the controller, around a motion of constant acceleration.

    Attributes:
        positions, velocities, accelerations: at the start of the control period, (12,) in [rad], [rad/s], [rad/s^2].
        proportional: in [N m/rad].
        derivative: in [N m s/rad].
    """

    positions: Array
    velocities: Array
    accelerations: Array
    proportional: float
    derivative: float

    def torques(self, elapsed_s: float, positions: Array, velocities: Array) -> Array:
        """Return the correction, (12,) in [N m].

        Args:
            elapsed_s: since the start of the control period in [s].
            positions, velocities: measured, (12,) in [rad], [rad/s].
        """
        position = self.positions + self.velocities * elapsed_s + 0.5 * self.accelerations * elapsed_s**2
        velocity = self.velocities + self.accelerations * elapsed_s
        return self.proportional * (position - positions) + self.derivative * (velocity - velocities)


@dataclass(frozen=True)
class JointCommand:
    """What a controller asks of the joints for one control period.

    Attributes:
        torques: (12,) in [N m], order ``JOINT_NAMES``.
        drive: added to the torques at the rate of the physics; None for torques alone.
    """

    torques: Array
    drive: JointDrive | None = None
