"""Footholds that are fixed before the CoM is planned: the nominal stance, carried along the waypoints."""

from itertools import pairwise

import numpy as np

from quadlab.gaits.schedule import Swing
from quadlab.geometry.curve import Curve
from quadlab.geometry.rotations import Array
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.sampling import turned_vertices


def nominal_footholds(problem: PlanningProblem, heading: Curve) -> tuple[Array, ...]:
    """Return per foot (swings + 1, 3) in [m]: the given start, then where each swing ends.

    A foothold is the foot's nominal position around the waypoint path in the middle of its stance; the last one is
    that around the goal, since the motion ends at rest.

    Args:
        problem: schedule, waypoints and nominal stance.
        heading: yaw over time in [rad].
    """
    feet = []
    for foot, swings in enumerate(problem.schedule.swings):
        times = stance_middles(swings, problem.schedule.duration_s)
        yaws = np.array([heading(time)[0] for time in times])
        nominal = problem.model.nominal_feet[foot : foot + 1]
        places = problem.waypoints.positions_at(times) + turned_vertices(nominal, yaws).reshape(-1, 2)
        on_ground = np.column_stack([places, np.zeros(len(times))])
        feet.append(np.concatenate([problem.start.feet[foot : foot + 1], on_ground]))
    return tuple(feet)


def stance_middles(swings: tuple[Swing, ...], end_s: float) -> Array:
    """Return the middle of the stance after each swing, (swings,) in [s]; ``end_s`` for the last one."""
    middles = [0.5 * (before.end_s + after.start_s) for before, after in pairwise(swings)]
    return np.array([*middles, end_s] if swings else [])
