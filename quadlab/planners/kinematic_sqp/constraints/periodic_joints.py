"""Eq. (10): a cycle that repeats ends in the joint positions in which it begins."""

import numpy as np

from quadlab.planners.kinematic_sqp.grid import SampleGrid
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import Equality, tie


def periodic_joints(layout: SampleLayout, grid: SampleGrid) -> Equality:
    """Return phi_N = phi_p for every periodic cycle, p its first and N its last sample."""
    joints = layout.indices("joints")
    spans = [span for span in grid.spans if span.cycle.periodic]
    first = np.array([span.first for span in spans], dtype=np.intp)
    last = np.array([span.last for span in spans], dtype=np.intp)
    return tie("periodic_joints_rad", joints[last], joints[first])
