"""The planning problem, one type for all planners: where the robot is, where to, and when which foot stands."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from quadlab.constants import GRAVITY
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.robots.state import RobotState

if TYPE_CHECKING:  # loads pinocchio, which a problem for a pendulum needs not
    from quadlab.robots.model import RobotModel


@dataclass(frozen=True)
class PlanningModel:
    """What a planner needs to know of a robot.

    Attributes:
        com_height: height of the centre of mass over the ground in [m].
        nominal_feet: foot positions relative to the CoM in the heading frame, (F, 2) in [m]; F = 4 for a quadruped.
        reach: half size (forward, sideways) of the box around the nominal position that a foot may use, (2,) in [m].
        gravity: in [m/s^2].
        foot_vertices: corners of each foot in its own frame, (v, 2) in [m]; one at the origin for point feet.
    """

    com_height: float
    nominal_feet: Array
    reach: Array
    gravity: float = GRAVITY
    foot_vertices: Array = field(default_factory=lambda: np.zeros((1, 2)))


@dataclass(frozen=True)
class PlanStart:
    """The state a plan begins from, in the plan frame P (z up, ground at z = 0).

    Attributes:
        com_position: (2,) in [m].
        com_velocity: (2,) in [m/s].
        yaw: heading of the base in [rad].
        feet: contact points, or frames of longer feet at the given yaw, (F, 3) in [m].
        state: the whole state, for planners that move joints; None if only the point mass is known.
    """

    com_position: Array
    com_velocity: Array
    yaw: float
    feet: Array
    state: RobotState | None = None


@dataclass(frozen=True)
class Waypoints:
    """Where the CoM and the heading should be at given times; the last one is the goal, reached at rest.

    Attributes:
        times_s: (n,) increasing in [s].
        poses: (n, 3): x, y in [m] and yaw in [rad] (not wrapped), in the plan frame.
        yaw_rate: of the heading at the first one in [rad/s].
    """

    times_s: Array
    poses: Array
    yaw_rate: float = 0.0

    def positions_at(self, times_s: Array) -> Array:
        """Return x and y of the straight lines between them at ``times_s`` (s,) in [s]; (s, 2) in [m]."""
        return np.stack([np.interp(times_s, self.times_s, self.poses[:, axis]) for axis in range(2)], axis=1)


@dataclass(frozen=True)
class PlanningProblem:
    """Everything a planner is told.

    Attributes:
        start: state at time 0.
        waypoints: the path to the goal; the first one is the start.
        schedule: contact flags over the whole horizon.
        model: robot as a point mass with reachable boxes.
        robot: robot with its kinematics, for planners that move joints; None if only ``model`` is known.
    """

    start: PlanStart
    waypoints: Waypoints
    schedule: ContactSchedule
    model: PlanningModel
    robot: "RobotModel | None" = None
