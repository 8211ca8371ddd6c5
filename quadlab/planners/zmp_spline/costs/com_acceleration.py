"""A calm CoM: what Bellicoso 2016, VI-B minimises."""

import numpy as np

from quadlab.planners.zmp_spline.model import SplineModel
from quadlab.planners.zmp_spline.terms import SquaredCost

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)  # exact up to degree 7; squared accelerations have degree 6


def com_acceleration(model: SplineModel) -> SquaredCost:
    """Return the integral of |c_ddot|^2 over the plan in [m^2/s^3], by exact quadrature."""
    grid = model.grid
    segments = np.repeat(np.arange(grid.count), len(_NODES))
    local = (0.5 * grid.durations_s[:, None] * (1.0 + _NODES)).ravel()
    shares = (0.5 * grid.durations_s[:, None] * _WEIGHTS).ravel()
    weights = np.repeat(grid.weights(segments, local, 2), 2, axis=0)
    axes = np.tile(np.eye(2), (len(segments), 1))
    rows = grid.rows(np.repeat(segments, 2), weights, axes)
    return SquaredCost("com_acceleration", rows, np.zeros(len(weights)), np.repeat(shares, 2))
