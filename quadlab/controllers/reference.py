"""What the tasks of one tick shall follow, in world components."""

from dataclasses import dataclass
from functools import cached_property

from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array


@dataclass(frozen=True)
class ControlReference:
    """Desired motion and limits of one control tick.

    Attributes:
        com_position, com_velocity, com_acceleration: x and y, (2,) in [m], [m/s], [m/s^2].
        base_position: x and y of the base origin, (2,) in [m].
        base_height: of the base origin in [m].
        base_velocity, base_acceleration: of the base origin, (3,) in [m/s], [m/s^2].
        base_rotation: base to world, (3, 3).
        base_angular_velocity, base_angular_acceleration: (3,) in [rad/s], [rad/s^2].
        foot_positions, foot_velocities, foot_accelerations: contact points of the legs in the air, (4, 3)
            in [m], [m/s], [m/s^2]; rows of standing legs are NaN.
        stance: which legs carry load, (4,).
        normal_force_limits: largest normal force of each leg, (4,) in [N].
        torque_limits: of the joints, (12,) in [N m].
        joint_position_limits: lower and upper, (12, 2) in [rad].
        weight: of the robot in [N].
        standing_height: of the base over the ground in the nominal stance, in [m].
        ground_axes: columns heading, lateral and normal of the ground, (3, 3).
    """

    com_position: Array
    com_velocity: Array
    com_acceleration: Array
    base_position: Array
    base_height: float
    base_velocity: Array
    base_acceleration: Array
    base_rotation: Array
    base_angular_velocity: Array
    base_angular_acceleration: Array
    foot_positions: Array
    foot_velocities: Array
    foot_accelerations: Array
    stance: BoolArray
    normal_force_limits: Array
    torque_limits: Array
    joint_position_limits: Array
    weight: float
    standing_height: float
    ground_axes: Array

    @cached_property
    def stance_legs(self) -> list[int]:
        """Numbers of the legs that carry load."""
        return [leg for leg, stands in enumerate(self.stance.tolist()) if stands]

    @cached_property
    def swing_legs(self) -> list[int]:
        """Numbers of the legs in the air."""
        return [leg for leg, stands in enumerate(self.stance.tolist()) if not stands]
