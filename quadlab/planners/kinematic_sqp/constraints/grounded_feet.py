"""Eq. (4): a foot that stands does not move."""

from quadlab.planners.kinematic_sqp.grid import SampleGrid
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import Equality, tie


def grounded_feet(layout: SampleLayout, grid: SampleGrid) -> Equality:
    """Return e_{k,i} = e_{k,i-1} for every interval in which leg k stands."""
    feet = layout.foot_indices()
    return tie("grounded_feet_m", feet[1:][grid.contacts], feet[:-1][grid.contacts])
