"""The given start and the goal."""

import casadi as ca
import numpy as np

from quadlab.planners.vertex_zmp.grid import TimeGrid
from quadlab.planners.vertex_zmp.paper.symbols import Symbols
from quadlab.planners.vertex_zmp.paper.terms import Constraint, equality


def start_state(symbols: Symbols) -> Constraint:
    """Return x(0) - x_0 = 0 for CoM position in [m] and velocity in [m/s], Winkler 2017, Eq. (2b).

    The initial footholds are parameters of the program and need no constraint.
    """
    first, zero = np.array([0]), np.array([0.0])
    position, velocity = symbols.com.at(first, zero), symbols.com.at(first, zero, 1)
    return equality("start_state", ca.vertcat(position - symbols.start_com, velocity - symbols.start_velocity))


def goal_state(symbols: Symbols, grid: TimeGrid) -> Constraint:
    """Return x(T) - x_T = 0: CoM at the goal in [m], at rest in [m/s], Winkler 2017, Eq. (2e)."""
    last, one = np.array([grid.count - 1]), np.array([1.0])
    position, velocity = symbols.com.at(last, one), symbols.com.at(last, one, 1)
    return equality("goal_state", ca.vertcat(position - symbols.goal, velocity))
