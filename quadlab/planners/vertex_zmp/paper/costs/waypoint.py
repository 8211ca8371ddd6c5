"""The CoM near the waypoints on the way to the goal."""

import casadi as ca

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.grid import TimeGrid
from quadlab.planners.vertex_zmp.paper.symbols import Symbols
from quadlab.planners.vertex_zmp.paper.terms import Cost


def waypoint(symbols: Symbols, grid: TimeGrid, times_s: Array, weight: float) -> Cost:
    """Return the distance of the CoM from each waypoint between start and goal at its time, in [m^2].

    J = sum_i ||c(t_i) - w_i||^2; an addition to Winkler 2017, which knows only the goal.

    Args:
        symbols: unknowns and parameters.
        grid: time grid.
        times_s: times of the waypoints, (w,) in [s].
        weight: factor of the cost in [1/m^2].
    """
    pieces, fractions = grid.locate(times_s)
    return Cost("waypoint", weight, ca.sumsqr(symbols.com.at(pieces, fractions) - symbols.waypoints))
