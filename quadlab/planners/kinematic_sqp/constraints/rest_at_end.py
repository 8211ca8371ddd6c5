"""A motion that ends with a stance of all feet ends at rest."""

import numpy as np

from quadlab.planners.kinematic_sqp.grid import SampleGrid
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import Equality, tie

_BLOCKS = ("base_position", "base_rotation", "com")


def rest_at_end(layout: SampleLayout, grid: SampleGrid) -> Equality:
    """Return equal last samples of base and CoM; nothing if the motion goes on for ever (as in the paper)."""
    index = np.concatenate([layout.indices(block) for block in _BLOCKS], axis=1)
    rows = slice(-1, None) if grid.ends_at_rest else slice(0, 0)
    return tie("rest_at_end_m", index[rows], np.roll(index, 1, axis=0)[rows])
