"""Eq. (9), second line: the base turns by the commanded angle in every cycle."""

import numpy as np

from quadlab.planners.kinematic_sqp.grid import SampleGrid
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.objectives.commanded_spans import commanded_spans
from quadlab.planners.kinematic_sqp.term import LinearTerm, rows

_YAW = 0  # the first entry of the base rotation


def turning_angle(name: str, layout: SampleLayout, grid: SampleGrid, periodic: bool, weight: float) -> LinearTerm:
    """Return the objective of all periodic or of all other cycles.

    Args:
        name: of the objective.
        layout: of p.
        grid: samples and cycles.
        periodic: which cycles.
        weight: in [1/rad^2].
    """
    yaw = layout.indices("base_rotation")[:, _YAW]
    spans = [span for span in commanded_spans(grid) if span.periodic == periodic]
    begin = yaw[[span.first for span in spans]]
    end = yaw[[span.last for span in spans]]
    target = np.array([float(span.increment[2]) for span in spans])
    return LinearTerm(name, weight, rows([(end, 1.0), (begin, -1.0)], layout.size), target)
