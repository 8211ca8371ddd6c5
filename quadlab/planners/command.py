"""What a user asks for, a displacement a stride or a goal, as waypoints of the centre of mass and the heading."""

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from quadlab.configuration import StrictModel
from quadlab.errors import ConfigurationError
from quadlab.geometry.rotations import Array, rotation_2d
from quadlab.planners.problem import Waypoints

_TIME_TOLERANCE = 1e-9  # [s]
_SMALLEST_STRIDE_SUM = 1e-6  # a sum of unit steps shorter than this closes on itself


class PerStrideCommand(StrictModel):
    """The same displacement in every stride, seen from the pose in which the stride begins.

    Attributes:
        x_m, y_m: forward and leftward displacement of one stride in [m].
        yaw_deg: change of heading over one stride in [deg], positive to the left.
    """

    kind: Literal["per_stride"]
    x_m: float
    y_m: float
    yaw_deg: float


class GoalCommand(StrictModel):
    """The displacement of the whole motion, seen from the start pose; all strides have equal shares of it.

    Attributes:
        x_m, y_m: forward and leftward displacement in [m].
        yaw_deg: change of heading in [deg], positive to the left; more than a full turn is a full turn.
    """

    kind: Literal["goal"]
    x_m: float
    y_m: float
    yaw_deg: float


CommandConfig = Annotated[PerStrideCommand | GoalCommand, Field(discriminator="kind")]


def waypoints(
    command: PerStrideCommand | GoalCommand, stride_times: Sequence[float], start_pose: Array, duration_s: float
) -> Waypoints:
    """Return where the CoM and the heading should be at the end of every stride.

    The start pose is a waypoint too, at time 0 and, after a first stance, at its end: planners with a weight on
    waypoints draw the CoM to it there, just when it has to lean to the feet that stay.

    Args:
        command: what the user asks for.
        stride_times: start of every stride and end of the last one, in [s].
        start_pose: x, y in [m] and yaw in [rad] at time 0, (3,).
        duration_s: length of the plan in [s]; the goal is held from the end of the last stride on.

    Raises:
        ConfigurationError: if a goal cannot be divided into equal strides.
    """
    increment = _stride_increment(command, len(stride_times) - 1)
    poses = [np.asarray(start_pose, float)]
    for _ in range(len(stride_times) - 1):
        poses.append(compose(poses[-1], increment))
    times = np.array([0.0, *stride_times, duration_s])
    path = np.array([poses[0], *poses, poses[-1]])
    keep = np.r_[True, np.diff(times) > _TIME_TOLERANCE]
    return Waypoints(times[keep], path[keep])


def compose(pose: Array, increment: Array) -> Array:
    """Return ``pose`` moved by ``increment``, which is seen from ``pose``; both x, y, yaw, (3,)."""
    return np.concatenate([pose[:2] + rotation_2d(float(pose[2])) @ increment[:2], [pose[2] + increment[2]]])


def _stride_increment(command: PerStrideCommand | GoalCommand, strides: int) -> Array:
    """Return the displacement of one stride, (3,)."""
    asked = np.array([command.x_m, command.y_m, np.deg2rad(command.yaw_deg)])
    return asked if isinstance(command, PerStrideCommand) else _equal_share(asked, strides)


def _equal_share(goal: Array, strides: int) -> Array:
    """Return the increment d whose n-fold composition is ``goal``, both (3,).

    With turn = yaw / n a stride, the positions add up to (sum_k R(k turn)) d_xy = goal_xy.
    """
    turn = float(goal[2]) / strides
    if not goal[:2].any():
        return np.array([0.0, 0.0, turn])
    stride_sum = np.sum([rotation_2d(k * turn) for k in range(strides)], axis=0)
    if np.hypot(stride_sum[0, 0], stride_sum[1, 0]) < _SMALLEST_STRIDE_SUM * strides:
        raise ConfigurationError(
            f"command: equal strides with a turn of {np.rad2deg(goal[2]):g} deg end where they began, not at "
            f"x_m {goal[0]:g}, y_m {goal[1]:g}; choose another yaw_deg or the kind per_stride"
        )
    return np.append(np.linalg.solve(stride_sum, goal[:2]), turn)
