"""The desired motion of the torso: laid under the CoM, or the planned base (Gehring 2017, III-C)."""

import math
from typing import NamedTuple

import numpy as np

from quadlab.controllers.tracking.alignment import PlanarPose, Point
from quadlab.controllers.tracking.torso import torso_rotation
from quadlab.estimation.terrain_plane import TerrainPlane
from quadlab.geometry.pose_curve import PoseMotion
from quadlab.geometry.rotations import Array, rotation_z, yaw_of

_NONE = np.zeros(3)


class Ground(NamedTuple):
    """What the torso stands over.

    Attributes:
        plane: local ground.
        height: of the ground under the base in [m].
        slope_following: share of the slope that roll and pitch follow.
    """

    plane: TerrainPlane
    height: float
    slope_following: float


class NominalStance(NamedTuple):
    """Where the CoM lies in the nominal stance.

    Attributes:
        com_in_base: CoM relative to the base origin, x and y in [m].
        base_height: of the base origin over the ground in [m].
    """

    com_in_base: Point
    base_height: float


def torso_under_com(
    com: tuple[Array, Array, Array], turning: tuple[float, float], ground: Ground, stance: NominalStance
) -> PoseMotion:
    """Return the motion, in the world, of a base that stays where it is relative to the CoM, at standing height.

    A deviation from Gehring 2017, whose planner moves the base under the CoM; pendulum planners know none. The CoM is a
    few centimetres below the base origin, which on slopes moves the base by some millimetres that are neglected.

    Args:
        com: desired position, velocity and acceleration of the CoM, (2,) each in [m], [m/s], [m/s^2].
        turning: desired heading in [rad] and its rate in [rad/s].
        ground: under the base.
        stance: nominal.
    """
    (x, y), (vx, vy), (ax, ay) = (part.tolist() for part in com)
    heading, yaw_rate = turning
    cosine, sine = math.cos(heading), math.sin(heading)
    forward, left = stance.com_in_base
    place = (x - (cosine * forward - sine * left), y - (sine * forward + cosine * left))
    return PoseMotion(
        position=np.array([*place, ground.height + stance.base_height]),
        velocity=np.array([vx, vy, 0.0]),
        acceleration=np.array([ax, ay, 0.0]),
        rotation=torso_rotation(heading, ground.plane, ground.slope_following),
        angular_velocity=np.array([0.0, 0.0, yaw_rate]),
        angular_acceleration=_NONE,
    )


def planned_torso(planned: PoseMotion, alignment: PlanarPose, clock: tuple[float, float], ground: Ground) -> PoseMotion:
    """Return the planned motion of the base where the plan lies in the world.

    Heights are those over the ground under the base; roll and pitch of the plan come on top of those of the ground.
    Angular velocities turn about axes of the plan's level ground, also over a slope.

    Args:
        planned: in the plan frame.
        alignment: of the torso.
        clock: seconds of the plan in a second, and the change of this rate in [1/s].
        ground: under the base.
    """
    rate, rate_change = clock
    turn, heading = rotation_z(alignment.yaw), yaw_of(planned.rotation)
    leaning = rotation_z(-heading) @ planned.rotation
    x, y, z = planned.position.tolist()
    return PoseMotion(
        position=np.array([*alignment.moved(x, y), ground.height + z]),
        velocity=rate * turn @ planned.velocity,
        acceleration=turn @ (rate**2 * planned.acceleration + rate_change * planned.velocity),
        rotation=torso_rotation(heading + alignment.yaw, ground.plane, ground.slope_following) @ leaning,
        angular_velocity=rate * turn @ planned.angular_velocity,
        angular_acceleration=turn @ (rate**2 * planned.angular_acceleration + rate_change * planned.angular_velocity),
    )
