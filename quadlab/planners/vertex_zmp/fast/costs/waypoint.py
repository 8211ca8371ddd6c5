"""The CoM near the waypoints on the way to the goal."""

from quadlab.planners.vertex_zmp.fast.model import ReducedModel
from quadlab.planners.vertex_zmp.fast.rows import Rows, on_both_axes


def waypoint(model: ReducedModel) -> Rows:
    """Return the distance of the CoM from each waypoint between start and goal at its time, in [m].

    J = sum_i ||c(t_i) - w_i||^2; an addition to Winkler 2017, which knows only the goal.
    """
    waypoints = model.problem.waypoints
    intervals, fractions = model.grid.locate(waypoints.times_s[1:-1])
    both = on_both_axes(model.knot_columns(intervals), model.spline.weights(intervals, fractions))
    return Rows("waypoint", *both, -waypoints.poses[1:-1, :2].ravel())
