"""Eq. (9), first line: the CoM travels the commanded distance in every cycle."""

import numpy as np

from quadlab.geometry.rotations import rotation_2d
from quadlab.planners.kinematic_sqp.grid import SampleGrid
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.objectives.commanded_spans import commanded_spans
from quadlab.planners.kinematic_sqp.term import LinearTerm, rows


def travel_distance(name: str, layout: SampleLayout, grid: SampleGrid, periodic: bool, weight: float) -> LinearTerm:
    """Return the objective of all periodic or of all other cycles.

    The stances before the first and after the last step belong to the cycles beside them: what the CoM travels there
    counts too. The distance is also asked to be level.

    Args:
        name: of the objective.
        layout: of p.
        grid: samples and cycles.
        periodic: which cycles.
        weight: in [1/m^2].
    """
    com = layout.indices("com")
    spans = [span for span in commanded_spans(grid) if span.periodic == periodic]
    begin = np.concatenate([com[span.first] for span in spans] or [com[0, :0]])
    end = np.concatenate([com[span.last] for span in spans] or [com[0, :0]])
    target = np.array([[*(rotation_2d(span.heading) @ span.increment[:2]), 0.0] for span in spans])
    return LinearTerm(name, weight, rows([(end, 1.0), (begin, -1.0)], layout.size), target.ravel())
