"""Load spread evenly over the feet in contact."""

import casadi as ca
import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.grid import TimeGrid
from quadlab.planners.vertex_zmp.paper.symbols import Symbols, vertex_contacts
from quadlab.planners.vertex_zmp.paper.terms import Cost


def robustness(symbols: Symbols, grid: TimeGrid, weight: float) -> Cost:
    """Return the deviation from equal load, Winkler 2017, Eq. (20)-(21).

    J = sum_i w_i ||lambda_i - lambda_i*||^2 with lambda* = 1 / (number of vertices in contact).

    Deviation: node i counts with its share w_i of time in [s] (Simpson's rule), so that the cost does not depend on
    the grid; the paper has equal nodes and w_i = 1.
    """
    contacts = vertex_contacts(grid, symbols.loads.shape[0] // grid.node_contacts.shape[1])
    even = (contacts / contacts.sum(axis=1, keepdims=True))[contacts]
    node_weights = np.broadcast_to(simpson_weights(grid)[:, None], contacts.shape)[contacts]
    loads = symbols.loads.nz[:]
    return Cost("robustness", weight, ca.dot(ca.DM(node_weights), (loads - ca.DM(even)) ** 2))


def simpson_weights(grid: TimeGrid) -> Array:
    """Return the weight of each load node in the integral over time, start, middle and end an interval, (N,) in [s]."""
    weights = np.zeros(len(grid.node_phases))
    np.add.at(weights, grid.nodes, grid.durations_s[:, None] * np.array([1.0, 4.0, 1.0]) / 6.0)
    return weights
