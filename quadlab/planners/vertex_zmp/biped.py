"""A biped for the vertex-ZMP planner: feet with length, yaw as a variable, double support (Winkler 2017, Fig. 3)."""

import numpy as np

from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.planners.problem import PlanningModel, PlanningProblem, PlanStart, Waypoints

RECTANGULAR_FOOT = np.array([[0.10, 0.05], [0.10, -0.05], [-0.10, -0.05], [-0.10, 0.05]])  # [m]
LINE_FOOT = np.array([[0.10, 0.0], [-0.10, 0.0]])  # [m]


def biped_model(foot_vertices: Array) -> PlanningModel:
    """Return a biped with feet of the given vertices, (v, 2) in [m]."""
    return PlanningModel(
        com_height=0.8,  # [m]
        nominal_feet=np.array([[0.0, 0.12], [0.0, -0.12]]),  # [m]
        reach=np.array([0.25, 0.08]),  # [m]
        foot_vertices=foot_vertices,
    )


def biped_schedule(steps: int, swing_s: float = 0.4, double_support_s: float = 0.2) -> ContactSchedule:
    """Return a walk: double support, then alternating swings, left first, each followed by double support.

    Args:
        steps: number of swings.
        swing_s, double_support_s: durations in [s].
    """
    swings = [[False, True], [True, False]]
    contacts = [[True, True]] + [flags for step in range(steps) for flags in (swings[step % 2], [True, True])]
    durations = [double_support_s] + [swing_s, double_support_s] * steps
    return ContactSchedule(np.array(durations), np.array(contacts))


def biped_problem(foot_vertices: Array, steps: int, goal: Array) -> PlanningProblem:
    """Return the problem to walk to ``goal``: x, y in [m] and yaw in [rad], (3,)."""
    model, schedule = biped_model(foot_vertices), biped_schedule(steps)
    start = PlanStart(np.zeros(2), np.zeros(2), 0.0, np.column_stack([model.nominal_feet, np.zeros(2)]))
    path = np.array([np.zeros(3), goal])
    return PlanningProblem(start, Waypoints(np.array([0.0, schedule.duration_s]), path), schedule, model)
