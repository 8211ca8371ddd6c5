"""A calm CoM."""

import casadi as ca
import numpy as np

from quadlab.planners.vertex_zmp.grid import TimeGrid
from quadlab.planners.vertex_zmp.paper.symbols import Symbols
from quadlab.planners.vertex_zmp.paper.terms import Cost


def com_acceleration(symbols: Symbols, grid: TimeGrid, weight: float) -> Cost:
    """Return the squared acceleration of the CoM over time, in [m^2/s^3].

    J = int ||c_ddot||^2 dt, by Simpson's rule over the start, middle and end of each polynomial.

    Addition to Winkler 2017: with J_lambda alone a slow walk hurries from one support centre to the next.
    """
    pieces = np.arange(grid.count)
    total = ca.SX(0)
    for fraction, share in ((0.0, 1.0 / 6.0), (0.5, 4.0 / 6.0), (1.0, 1.0 / 6.0)):
        acceleration = symbols.com.at(pieces, np.full(grid.count, fraction), 2)
        total += ca.dot(ca.DM(np.tile(share * grid.durations_s, (2, 1))), acceleration**2)
    return Cost("com_acceleration", weight, total)
