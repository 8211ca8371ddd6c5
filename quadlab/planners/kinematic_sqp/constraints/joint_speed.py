"""Eq. (6): no joint is faster than its drive."""

import numpy as np

from quadlab.planners.kinematic_sqp.grid import SampleGrid
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import Inequality, rows


def joint_speed(layout: SampleLayout, grid: SampleGrid, limit: float) -> Inequality:
    """Return |phi_{i+1} - phi_i| / h_i <= limit.

    Args:
        layout: of p.
        grid: samples.
        limit: of all joints in [rad/s].
    """
    joints = layout.indices("joints")
    rates = np.repeat(1.0 / grid.periods_s, joints.shape[1])
    matrix = rows([(joints[1:].ravel(), rates), (joints[:-1].ravel(), -rates)], layout.size)
    bound = np.full(matrix.shape[0], limit)
    return Inequality("joint_speed_radps", matrix, -bound, bound)
