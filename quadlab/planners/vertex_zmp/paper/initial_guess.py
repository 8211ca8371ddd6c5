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
    knots = problem.waypoints.positions_at(grid.knots_s).T
    coefficients = np.zeros((2 * COEFFICIENT_COUNT, grid.count))
    coefficients[0:2] = knots[:, :-1]
    coefficients[2:4] = np.diff(knots, axis=1)
    contacts = vertex_contacts(grid, len(problem.model.foot_vertices))
    middles_s = footholds.free_middles_s
    yaws = np.array([heading(float(time))[0] for time in middles_s])
    nominal = footholds.nominal_places(problem.model.nominal_feet, yaws)
    return layout.pack(
        {
            "com_coefficients": coefficients,
            "footholds": (problem.waypoints.positions_at(middles_s) + nominal).T,
            "foot_yaws": yaws[None, : layout.shapes["foot_yaws"][1]],
            "loads": (contacts / contacts.sum(axis=1, keepdims=True))[contacts][:, None],
        }
    )
