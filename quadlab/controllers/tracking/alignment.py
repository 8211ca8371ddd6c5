"""Where the plan lies in the world: the alignment of plan frame P and inertial frame I (Gehring 2017, III-A)."""

import math
from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array, wrap_angle


@dataclass(frozen=True)
class PlanarPose:
    """A rotation about the vertical and a pair of points that it lays upon each other (Eq. 11-12).

    Attributes:
        point_in_plan, point_in_world: the reference point R in both frames, (2,) in [m].
        yaw: from plan axes to world axes in [rad].
    """

    point_in_plan: Array
    point_in_world: Array
    yaw: float

    def position(self, position_in_plan: Array) -> Array:
        """Return a point of the plan, (2,) in [m], in the world."""
        moved: Array = self.point_in_world + self.vector(position_in_plan - self.point_in_plan)
        return moved

    def vector(self, vector_in_plan: Array) -> Array:
        """Return a direction of the plan, (2,), in world axes."""
        cosine, sine = math.cos(self.yaw), math.sin(self.yaw)
        x, y = vector_in_plan.tolist()  # numbers of Python: a tick turns a dozen vectors
        return np.array([cosine * x - sine * y, sine * x + cosine * y])

    def origin(self) -> Array:
        """Return x, y in [m] and yaw in [rad] of the plan frame in the world, (3,)."""
        return self.pose(np.zeros(3))

    def pose(self, pose_in_plan: Array) -> Array:
        """Return x, y in [m] and yaw in [rad] in the world of a pose in the plan, both (3,)."""
        return np.array([*self.position(pose_in_plan[:2]), pose_in_plan[2] + self.yaw])


def identity_alignment() -> PlanarPose:
    """Return the alignment of a plan that lies where it was made."""
    return PlanarPose(np.zeros(2), np.zeros(2), 0.0)


def feet_alignment(planned_feet: Array, measured_feet: Array) -> PlanarPose:
    """Align mean and heading of the feet: of standing feet their stance points, of others their lift-off points.

    Args:
        planned_feet: the footholds in the plan, (4, 2) in [m], order ``LEGS``.
        measured_feet: the same feet in the world, (4, 2) in [m].
    """
    planned, planned_heading = _feet_pose(planned_feet)
    measured, measured_heading = _feet_pose(measured_feet)
    return PlanarPose(planned, measured, wrap_angle(measured_heading - planned_heading))


def base_alignment(
    planned_position: Array, planned_yaw: float, measured_position: Array, measured_yaw: float
) -> PlanarPose:
    """Align position, (2,) in [m], and heading in [rad] of the torso (its centre of mass serves as reference point)."""
    return PlanarPose(planned_position, measured_position, wrap_angle(measured_yaw - planned_yaw))


def _feet_pose(feet: Array) -> tuple[Array, float]:
    """Return the mean of the feet, (2,) in [m], and the direction from hind to fore feet in [rad]."""
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = feet.tolist()
    mean = np.array([0.25 * (x0 + x1 + x2 + x3), 0.25 * (y0 + y1 + y2 + y3)])
    return mean, math.atan2(y0 + y1 - y2 - y3, x0 + x1 - x2 - x3)


class SmoothedAlignment:
    """First-order filter of an alignment that jumps whenever a new foothold is established.

    A jump is turned into an offset that leaves the plan's torso where it was and then decays.
    """

    def __init__(self, time_constant_s: float, alignment: PlanarPose) -> None:
        self.time_constant_s = time_constant_s
        self.current = alignment
        """The alignment as it was returned last."""

    def update(self, raw: PlanarPose, torso_in_plan: Array, period_s: float) -> PlanarPose:
        """Return the smoothed alignment.

        Args:
            raw: alignment of this tick.
            torso_in_plan: planned position that must not jump, (2,) in [m].
            period_s: control period in [s].
        """
        before, decay = self.current, math.exp(-period_s / self.time_constant_s)
        yaw_offset = wrap_angle(before.yaw - raw.yaw)
        turned = PlanarPose(raw.point_in_plan, raw.point_in_world, raw.yaw + yaw_offset)
        offset = before.position(torso_in_plan) - turned.position(torso_in_plan)
        self.current = PlanarPose(raw.point_in_plan, raw.point_in_world + decay * offset, raw.yaw + decay * yaw_offset)
        return self.current
