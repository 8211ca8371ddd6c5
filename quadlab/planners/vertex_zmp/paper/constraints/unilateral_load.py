"""Feet push and never pull: the CoP stays in the hull of the feet in contact."""

import casadi as ca
import numpy as np

from quadlab.planners.vertex_zmp.grid import TimeGrid
from quadlab.planners.vertex_zmp.paper.symbols import Symbols
from quadlab.planners.vertex_zmp.paper.terms import Constraint, equality


def load_sum(symbols: Symbols) -> Constraint:
    """Return that the load shares of each node add up to one, Winkler 2017, Eq. (19a), no unit.

    Eq. (19b), 0 <= lambda <= c, is a bound on the variables: feet in the air have no variable, and lambda <= 1
    follows from the sum.
    """
    return equality("load_sum", ca.sum1(symbols.loads) - 1.0)


def load_between_nodes(symbols: Symbols, grid: TimeGrid) -> Constraint:
    """Return that no load is negative between the nodes either, no unit.

    Addition to the paper. Over a polynomial lambda is the parabola through its three nodes; in Bernstein form its
    middle coefficient is 2 lambda_m - (lambda_0 + lambda_1) / 2. A parabola with non-negative Bernstein coefficients
    is non-negative, so with this the CoP cannot leave the hull between the nodes.
    """
    start, middle, end = (symbols.loads[:, grid.nodes[:, node].tolist()] for node in range(3))
    coefficients = (2.0 * middle - 0.5 * (start + end)).nz[:]
    count = coefficients.numel()
    return Constraint("load_between_nodes", coefficients, np.zeros(count), np.full(count, np.inf))
