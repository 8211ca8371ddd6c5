"""Continuity of the CoM spline."""

import numpy as np

from quadlab.planners.vertex_zmp.grid import TimeGrid
from quadlab.planners.vertex_zmp.paper.symbols import Symbols
from quadlab.planners.vertex_zmp.paper.terms import Constraint, equality


def com_continuity(symbols: Symbols, grid: TimeGrid) -> list[Constraint]:
    """Return equal position and velocity at each junction, Winkler 2017, Eq. (10).

    x[t_{k+1}^-] = x[t_{k+1}^+]; positions in [m], velocities in [m/s].
    """
    inner = np.arange(grid.count - 1)
    zeros, ones = np.zeros(len(inner)), np.ones(len(inner))
    jumps = [symbols.com.at(inner, ones, d) - symbols.com.at(inner + 1, zeros, d) for d in (0, 1)]
    return [equality("com_continuity_m", jumps[0]), equality("com_velocity_continuity_m_s", jumps[1])]
