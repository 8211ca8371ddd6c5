"""Everything that a term of the reduced program may refer to."""

from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.vertex_zmp.fast.columns import Columns
from quadlab.planners.vertex_zmp.fast.tension_spline import TensionSpline
from quadlab.planners.vertex_zmp.footholds import FootholdIndex, IntArray
from quadlab.planners.vertex_zmp.grid import TimeGrid


@dataclass(frozen=True)
class ReducedModel:
    """A problem with its grid, numbering and pendulum.

    Attributes:
        problem: in words.
        heading: yaw over time in [rad].
        grid: intervals and load nodes.
        footholds: numbering of the stances.
        columns: numbering of the vector.
        spline: CoM between the knots.
    """

    problem: PlanningProblem
    heading: PiecewisePolynomial
    grid: TimeGrid
    footholds: FootholdIndex
    columns: Columns
    spline: TensionSpline

    def knot_columns(self, intervals: IntArray) -> IntArray:
        """Return where c_0, v_0, c_1, v_1 of given intervals (s,) sit, (s, 4, 2 axes)."""
        states = self.columns.states
        return np.concatenate([states[intervals], states[intervals + 1]], axis=1)

    def yaw(self, times_s: Array) -> Array:
        """Return the heading at ``times_s``, (s,) in [rad]; held after its end."""
        knots = self.heading.knots
        piece = np.clip(np.searchsorted(knots, times_s, side="right") - 1, 0, len(knots) - 2)
        values = self.heading.on_pieces(piece, np.clip(times_s, knots[0], knots[-1]) - knots[piece])
        return values[:, 0]
