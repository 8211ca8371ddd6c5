"""A motion that ends with a stance of all feet ends at rest."""

import numpy as np

from quadlab.planners.kinematic_sqp.grid import SampleGrid
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import Equality, tie

_BLOCKS = ("base_position", "base_rotation", "com")


def rest_at_end(layout: SampleLayout, grid: SampleGrid) -> Equality:
    """Return equal last samples of base and CoM; nothing if the motion goes on for ever (as in the paper)."""
    count = 1 if grid.ends_at_rest else 0
    last = np.concatenate([layout.indices(block)[-1] for block in _BLOCKS] * count or [np.zeros(0, dtype=np.intp)])
    before = np.concatenate([layout.indices(block)[-2] for block in _BLOCKS] * count or [np.zeros(0, dtype=np.intp)])
    return tie("rest_at_end_m", last, before)
