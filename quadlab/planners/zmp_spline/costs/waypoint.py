"""The CoM near the waypoints on its way."""

import numpy as np

from quadlab.planners.zmp_spline.model import SplineModel
from quadlab.planners.zmp_spline.terms import SquaredCost


def waypoint(model: SplineModel, weight: float) -> SquaredCost:
    """Return ``weight`` in [1/s^3] times the squared distances from the intermediate waypoints (not in the paper)."""
    waypoints, grid = model.problem.waypoints, model.grid
    times = waypoints.times_s[1:-1]
    segments = np.clip(np.searchsorted(grid.knots_s, times, side="right") - 1, 0, grid.count - 1)
    weights = np.repeat(grid.weights(segments, times - grid.knots_s[segments], 0), 2, axis=0)
    rows = grid.rows(np.repeat(segments, 2), weights, np.tile(np.eye(2), (len(times), 1)))
    return SquaredCost("waypoint", rows, waypoints.poses[1:-1, :2].ravel(), np.full(2 * len(times), weight))
