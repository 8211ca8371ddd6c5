"""How far the centre of pressure of a plan stays inside its support polygons."""

import numpy as np
from scipy.spatial import ConvexHull

from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan

POLYGON_FEET = 3


def support_margins(plan: MotionPlan, period_s: float) -> tuple[Array, Array]:
    """Return the distance of the CoP to the nearest edge of the support polygon, negative outside, over time.

    Args:
        plan: with point feet.
        period_s: between the samples in [s].

    Returns:
        Times in [s] and distances in [m], (n,) each; times at which fewer than three feet stand are left out.
    """
    times, margins = [], []
    for time_s in np.arange(0.5 * period_s, plan.duration_s, period_s):
        feet = standing_feet(plan, float(time_s))
        if len(feet) >= POLYGON_FEET:
            times.append(float(time_s))
            margins.append(edge_distance(plan.cop(float(time_s)), feet))
    return np.array(times), np.array(margins)


def standing_feet(plan: MotionPlan, time_s: float) -> Array:
    """Return where feet stand at ``time_s`` in [s], (k, 2) in the plan frame in [m]."""
    standing = np.flatnonzero(plan.schedule.contacts_at(time_s)).tolist()
    feet = [plan.foothold_at(leg, time_s)[:2] for leg in standing]
    return np.array(feet).reshape(-1, 2)


def edge_distance(point: Array, corners: Array) -> float:
    """Return how far ``point``, (2,), is from the nearest edge of the hull of ``corners``, (k, 2); negative outside."""
    equations = ConvexHull(corners).equations
    return float(-np.max(equations[:, :2] @ point + equations[:, 2]))
