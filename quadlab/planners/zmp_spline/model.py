"""What is known before the program is written: grid, samples, footholds, supports."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.heading import heading_spline
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.sampling import Samples, foot_path
from quadlab.planners.zmp_spline.footholds import nominal_footholds
from quadlab.planners.zmp_spline.hermite import GridSamples, HermiteGrid, grid_samples, hermite_grid
from quadlab.planners.zmp_spline.support import SupportPolygon, support_polygon


@dataclass(frozen=True)
class SplineModel:
    """The given part of a problem.

    Attributes:
        problem: in words.
        grid: segments of the CoM.
        samples: times at which constraints hold.
        heading: yaw over time in [rad].
        footholds: per foot (swings + 1, 3) in [m].
        margin: by which support polygons are smaller, in [m].
    """

    problem: PlanningProblem
    grid: HermiteGrid
    samples: GridSamples
    heading: PiecewisePolynomial
    footholds: tuple[Array, ...]
    margin: float

    @property
    def rate_squared(self) -> float:
        """Square of the pendulum's rate, g / h, in [1/s^2]."""
        return self.problem.model.gravity / self.problem.model.com_height

    @cached_property
    def supports(self) -> tuple[SupportPolygon, ...]:
        """What is left of the support of each phase inside the margin."""
        schedule, switches = self.problem.schedule, self.problem.schedule.switch_times_s
        found = []
        for phase, contacts in enumerate(schedule.contacts):
            middle = 0.5 * float(switches[phase] + switches[phase + 1])
            standing = np.flatnonzero(contacts).tolist()
            feet = [self.footholds[leg][schedule.swing_at(leg, middle)[0], :2] for leg in standing]
            found.append(support_polygon(np.array(feet), self.margin))
        return tuple(found)

    @cached_property
    def zmp_weights(self) -> Array:
        """How six knot states make up u = c - (h / g) c_ddot at each sample, (s, 6)."""
        segments, local_s = self.samples.segments, self.samples.local_s
        position, acceleration = (self.grid.weights(segments, local_s, order) for order in (0, 2))
        weights: Array = position - acceleration / self.rate_squared
        return weights

    @cached_property
    def feet(self) -> Array:
        """Every foot over the ground at each sample, standing or swinging, (s, F, 2) in [m]."""
        middles = self.grid.knots_s[:-1] + 0.5 * self.grid.durations_s
        samples = Samples(self.samples.times_s, middles[self.samples.segments])
        pairs = zip(self.footholds, self.problem.schedule.swings, strict=True)
        return np.stack([foot_path(footholds, swings, samples) for footholds, swings in pairs], axis=1)


def spline_model(problem: PlanningProblem, segment_s: float, sample_s: float, margin: float) -> SplineModel:
    """Return everything that is known of ``problem``; longest segment and sample distance in [s], margin in [m]."""
    grid, heading = hermite_grid(problem.schedule, segment_s), heading_spline(problem.waypoints)
    footholds = nominal_footholds(problem, heading)
    return SplineModel(problem, grid, grid_samples(grid, sample_s), heading, footholds, margin)
