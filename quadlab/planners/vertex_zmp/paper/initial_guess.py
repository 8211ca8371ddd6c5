"""Where the solver begins: the robot slides along the waypoints in its nominal stance."""

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.vertex_zmp.footholds import FootholdIndex
from quadlab.planners.vertex_zmp.grid import TimeGrid
from quadlab.planners.vertex_zmp.paper.layout import BlockLayout
from quadlab.planners.vertex_zmp.paper.symbols import COEFFICIENT_COUNT, vertex_contacts


def sliding_guess(
    problem: PlanningProblem,
    grid: TimeGrid,
    footholds: FootholdIndex,
    heading: PiecewisePolynomial,
    layout: BlockLayout,
) -> Array:
    """Return the first iterate: CoM on straight lines between waypoints, nominal footholds under it, equal loads.

    The paper begins with the robot standing in its default stance; for long horizons this is closer.
    """
    knots = _path(problem, grid.knots_s)
    coefficients = np.zeros((2 * COEFFICIENT_COUNT, grid.count))
    coefficients[0:2] = knots[:, :-1]
    coefficients[2:4] = np.diff(knots, axis=1)
    contacts = vertex_contacts(grid, len(problem.model.foot_vertices))
    free_yaws = [heading(float(time))[0] for time in footholds.free_middles_s]
    return layout.pack(
        {
            "com_coefficients": coefficients,
            "footholds": _nominal_footholds(problem, footholds, heading),
            "foot_yaws": np.array(free_yaws)[None, : layout.shapes["foot_yaws"][1]],
            "loads": (contacts / contacts.sum(axis=1, keepdims=True))[contacts][:, None],
        }
    )


def _path(problem: PlanningProblem, times_s: Array) -> Array:
    """Return the straight lines between waypoints at ``times_s``, (2, s)."""
    waypoints = problem.waypoints
    return np.array([np.interp(times_s, waypoints.times_s, waypoints.poses[:, axis]) for axis in range(2)])


def _nominal_footholds(problem: PlanningProblem, footholds: FootholdIndex, heading: PiecewisePolynomial) -> Array:
    """Return the nominal place of each free stance at its middle, (2, M - F)."""
    yaw = np.array([heading(float(time))[0] for time in footholds.free_middles_s])
    nominal = problem.model.nominal_feet[footholds.free_legs]
    turned: Array = np.array(
        [
            np.cos(yaw) * nominal[:, 0] - np.sin(yaw) * nominal[:, 1],
            np.sin(yaw) * nominal[:, 0] + np.cos(yaw) * nominal[:, 1],
        ]
    )
    return _path(problem, footholds.free_middles_s) + turned
