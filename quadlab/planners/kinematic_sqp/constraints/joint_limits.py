"""The joints stay within their limits at every sample but the first, which is measured."""

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import Inequality, rows


def joint_limits(layout: SampleLayout, limits: Array) -> Inequality:
    """Return lower <= phi_i <= upper.

    Args:
        layout: of p.
        limits: (12, 2) in [rad].
    """
    joints = layout.indices("joints")[1:]
    lower, upper = (np.tile(bound, len(joints)) for bound in limits.T)
    return Inequality("joint_limits_rad", rows([(joints.ravel(), 1.0)], layout.size), lower, upper)
