"""Eq. (9), first line: the CoM travels the commanded distance in every cycle."""

import numpy as np

from quadlab.geometry.rotations import rotation_2d
from quadlab.planners.kinematic_sqp.grid import CycleSpan, SampleGrid
from quadlab.planners.kinematic_sqp.layout import SampleLayout
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
    spans = [span for span in moving_spans(grid) if span.cycle.periodic == periodic]
    begin = np.concatenate([com[span.first] for span in spans] or [com[0, :0]])
    end = np.concatenate([com[span.last] for span in spans] or [com[0, :0]])
    target = np.array([[*(rotation_2d(span.heading) @ span.cycle.increment[:2]), 0.0] for span in spans])
    return LinearTerm(name, weight, rows([(end, 1.0), (begin, -1.0)], layout.size), target.ravel())


def moving_spans(grid: SampleGrid) -> list[CycleSpan]:
    """Return the cycles with steps, each with the rests that belong to it; all cycles if none has steps."""
    moving = [number for number, span in enumerate(grid.spans) if span.cycle.moves]
    spans = []
    for position, number in enumerate(moving):
        span = grid.spans[number]
        first = 0 if position == 0 else span.first
        following = moving[position + 1] if position + 1 < len(moving) else len(grid.spans)
        last = grid.spans[following - 1].last
        spans.append(CycleSpan(span.cycle, first, last, span.heading))
    return spans or list(grid.spans)
