"""From words to letters: the formulation as a list of named terms."""

import time
from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.plan import UNCHECKED, MotionPlan, PlanReport
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.zmp_spline.config import ZmpSplineConfig
from quadlab.planners.zmp_spline.constraints.range_of_motion import range_of_motion
from quadlab.planners.zmp_spline.constraints.zmp_in_support import zmp_in_support
from quadlab.planners.zmp_spline.costs.com_acceleration import com_acceleration
from quadlab.planners.zmp_spline.costs.support_centre import support_centre
from quadlab.planners.zmp_spline.costs.waypoint import waypoint
from quadlab.planners.zmp_spline.model import SplineModel, spline_model
from quadlab.planners.zmp_spline.program import QuadraticProgram, assemble


@dataclass(frozen=True)
class SplineTranscription:
    """A problem that has been transcribed and can be solved, any number of times.

    Attributes:
        model: what is known.
        program: what is to be found; None if a support is empty inside its margin and must not be.
        build_ms: wall time of both in [ms].
    """

    model: SplineModel
    program: QuadraticProgram | None
    build_ms: float

    @property
    def problem(self) -> PlanningProblem:
        """The problem in words."""
        return self.model.problem


def transcribe(problem: PlanningProblem, config: ZmpSplineConfig) -> SplineTranscription:
    """Return the quadratic program of a well-formed problem."""
    began = time.perf_counter()
    soft = config.support_slack_weight is not None
    margin = config.support_margin_m
    model = spline_model(problem, config.segment_duration_s, config.sample_period_s, margin)
    if not soft and any(support.is_empty for support in model.supports):
        return SplineTranscription(model, None, 1e3 * (time.perf_counter() - began))
    costs = [com_acceleration(model)]
    if config.support_centre_weight:
        costs.append(support_centre(model, config.support_centre_weight))
    if config.waypoint_weight and len(problem.waypoints.times_s) > 2:
        costs.append(waypoint(model, config.waypoint_weight))
    bounds = [zmp_in_support(model, config.support_slack_weight)]
    if config.reach_margin_m is not None:
        bounds.append(range_of_motion(model, config.reach_margin_m))
    program = assemble(model.grid, problem, costs, bounds)
    return SplineTranscription(model, program, 1e3 * (time.perf_counter() - began))


def motion_plan(model: SplineModel, states: Array, report: PlanReport) -> MotionPlan:
    """Return the plan of a vector of all knot states; its verdict is empty until it has been checked."""
    grid, horizontal = model.grid, model.grid.coefficients(states)
    com = np.zeros((*horizontal.shape[:2], 3))
    com[:, :, :2] = horizontal
    com[:, 0, 2] = model.problem.model.com_height
    return MotionPlan(
        schedule=model.problem.schedule,
        com=PiecewisePolynomial(grid.knots_s, com),
        heading=model.heading,
        cop=PiecewisePolynomial(grid.knots_s, zmp_polynomials(horizontal, model.rate_squared)),
        footholds=model.footholds,
        report=report,
        verdict=UNCHECKED,
    )


def zmp_polynomials(com: Array, rate_squared: float) -> Array:
    """Return the coefficients of u = c - (h / g) c_ddot from those of c, (n, 6, 2); g / h in [1/s^2]."""
    zmp = com.copy()
    powers = np.arange(2, com.shape[1])
    zmp[:, :-2] -= (powers * (powers - 1))[None, :, None] * com[:, 2:] / rate_squared
    return zmp
