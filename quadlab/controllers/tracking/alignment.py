"""Where the plan lies in the world: the alignment of plan frame P and inertial frame I (Gehring 2017, III-A).

A deviation: the paper lays P on the plane of the terrain. Here P turns about the vertical alone, so that horizontal
distances stay as planned, and heights are added over the terrain.
"""

import math
from typing import NamedTuple, TypeAlias

import numpy as np

from quadlab.geometry.rotations import Array, wrap_angle

Point: TypeAlias = tuple[float, float]
"""x and y in [m]; numbers of Python, since a tick moves a dozen points and arrays of two take longer."""


class PlanarPose(NamedTuple):
    """A rotation about the vertical and a pair of points that it lays upon each other (Eq. 11-12).

    Attributes:
        point_in_plan, point_in_world: the reference point R in both frames in [m].
        yaw: from plan axes to world axes in [rad].
    """

    point_in_plan: Point
    point_in_world: Point
    yaw: float

    def position(self, position_in_plan: Array) -> Array:
        """Return a point of the plan, (2,) in [m], in the world."""
        x, y = position_in_plan.tolist()
        return np.array(self.moved(x, y))

    def vector(self, vector_in_plan: Array) -> Array:
        """Return a direction of the plan, (2,), in world axes."""
        x, y = vector_in_plan.tolist()
        return np.array(self._turned(x, y))

    def moved(self, x: float, y: float) -> Point:
        """Return the point x, y of the plan in the world, all in [m]."""
        dx, dy = self._turned(x - self.point_in_plan[0], y - self.point_in_plan[1])
        return self.point_in_world[0] + dx, self.point_in_world[1] + dy

    def origin(self) -> Array:
        """Return x, y in [m] and yaw in [rad] of the plan frame in the world, (3,)."""
        return self.pose(np.zeros(3))

    def pose(self, pose_in_plan: Array) -> Array:
        """Return x, y in [m] and yaw in [rad] in the world of a pose in the plan, both (3,)."""
        x, y, yaw = pose_in_plan.tolist()
        return np.array([*self.moved(x, y), yaw + self.yaw])

    def _turned(self, x: float, y: float) -> Point:
        cosine, sine = math.cos(self.yaw), math.sin(self.yaw)
        return cosine * x - sine * y, sine * x + cosine * y


def identity_alignment() -> PlanarPose:
    """Return the alignment of a plan that lies where it was made."""
    return PlanarPose((0.0, 0.0), (0.0, 0.0), 0.0)


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
    planned, measured = _point(planned_position), _point(measured_position)
    return PlanarPose(planned, measured, wrap_angle(measured_yaw - planned_yaw))


def _point(position: Array) -> Point:
    x, y = position.tolist()
    return x, y


def _feet_pose(feet: Array) -> tuple[Point, float]:
    """Return the mean of the feet in [m] and the direction from hind to fore feet in [rad]."""
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = feet.tolist()
    mean = (0.25 * (x0 + x1 + x2 + x3), 0.25 * (y0 + y1 + y2 + y3))
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
        torso = _point(torso_in_plan)
        (x_before, y_before), (x_after, y_after) = before.moved(*torso), turned.moved(*torso)
        x, y = raw.point_in_world
        point_in_world = (x + decay * (x_before - x_after), y + decay * (y_before - y_after))
        self.current = PlanarPose(raw.point_in_plan, point_in_world, raw.yaw + decay * yaw_offset)
        return self.current
