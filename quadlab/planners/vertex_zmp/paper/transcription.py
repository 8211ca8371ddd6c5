"""From words to letters: a planning problem as a nonlinear program, a list of named terms."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.heading import heading_spline
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.vertex_zmp.config import VertexZmpConfig
from quadlab.planners.vertex_zmp.footholds import FootholdIndex
from quadlab.planners.vertex_zmp.grid import TimeGrid, time_grid
from quadlab.planners.vertex_zmp.paper.constraints.boundary import goal_state, start_state
from quadlab.planners.vertex_zmp.paper.constraints.lip_dynamics import lip_dynamics
from quadlab.planners.vertex_zmp.paper.constraints.quartic_spline import com_continuity
from quadlab.planners.vertex_zmp.paper.constraints.range_of_motion import range_of_motion, range_of_motion_times
from quadlab.planners.vertex_zmp.paper.constraints.unilateral_load import load_between_nodes, load_sum
from quadlab.planners.vertex_zmp.paper.costs.com_acceleration import com_acceleration
from quadlab.planners.vertex_zmp.paper.costs.foot_yaw import foot_yaw
from quadlab.planners.vertex_zmp.paper.costs.nominal_foothold import nominal_foothold
from quadlab.planners.vertex_zmp.paper.costs.robustness import robustness
from quadlab.planners.vertex_zmp.paper.costs.waypoint import waypoint
from quadlab.planners.vertex_zmp.paper.initial_guess import sliding_guess
from quadlab.planners.vertex_zmp.paper.layout import BlockLayout
from quadlab.planners.vertex_zmp.paper.symbols import Symbols, make_symbols, parameter_layout, variable_layout
from quadlab.planners.vertex_zmp.paper.terms import Constraint, Cost

NODES_PER_POLYNOMIAL = 3
"""Load nodes at start, middle and end of each polynomial."""


@dataclass(frozen=True)
class Transcription:
    """The nonlinear program of one problem: min f(x, p) with lower <= g(x, p) <= upper, lower_x <= x.

    Attributes:
        problem: in words.
        grid, footholds, heading: numbering of time and stances; heading over time in [rad].
        layout: blocks of x.
        x, p: symbolic variables and parameters, CasADi columns.
        constraints: named constraint sets; g is their concatenation.
        costs: named costs; f is their weighted sum.
        lower_x: lower bounds of x; there are no upper ones.
        guess: first iterate.
        parameters: value of p.
    """

    problem: PlanningProblem
    grid: TimeGrid
    footholds: FootholdIndex
    heading: PiecewisePolynomial
    layout: BlockLayout
    x: Any
    p: Any
    constraints: Sequence[Constraint]
    costs: Sequence[Cost]
    lower_x: Array
    guess: Array
    parameters: Array

    @property
    def f(self) -> Any:
        """The objective, CasADi scalar."""
        return sum((cost.weight * cost.expression for cost in self.costs), start=ca.SX(0))

    @property
    def g(self) -> Any:
        """All constraints, CasADi column."""
        return ca.vertcat(*(constraint.expression for constraint in self.constraints))

    @property
    def bounds_g(self) -> tuple[Array, Array]:
        """Lower and upper bounds of ``g``."""
        lower = np.concatenate([constraint.lower for constraint in self.constraints])
        return lower, np.concatenate([constraint.upper for constraint in self.constraints])


def transcribe(problem: PlanningProblem, config: VertexZmpConfig) -> Transcription:
    """Return the program of a well-formed problem."""
    grid = time_grid(problem.schedule, config.polynomial_duration_s, NODES_PER_POLYNOMIAL)
    footholds = FootholdIndex(problem.schedule)
    heading = heading_spline(problem.waypoints)
    passed = slice(1, -1)  # waypoints between start and goal
    waypoint_times = problem.waypoints.times_s[passed]
    vertices = len(problem.model.foot_vertices)
    layout = variable_layout(grid, footholds, vertices)
    parameters = parameter_layout(grid, footholds, len(waypoint_times))
    x, p = ca.SX.sym("x", layout.size), ca.SX.sym("p", parameters.size)
    symbols = make_symbols(grid, footholds, vertices, (layout, parameters), (x, p))
    return Transcription(
        problem=problem,
        grid=grid,
        footholds=footholds,
        heading=heading,
        layout=layout,
        x=x,
        p=p,
        constraints=_constraints(symbols, grid, footholds, problem, config),
        costs=[
            robustness(symbols, grid, config.robustness_weight),
            com_acceleration(symbols, grid, config.com_acceleration_weight),
            nominal_foothold(symbols, grid, footholds, problem.model, config.nominal_foothold_weight),
            waypoint(symbols, grid, waypoint_times, config.waypoint_weight),
            *([foot_yaw(symbols, footholds, config.foot_yaw_weight)] if vertices > 1 else []),
        ],
        lower_x=_lower_bounds(layout),
        guess=sliding_guess(problem, grid, footholds, heading, layout),
        parameters=parameters.pack(_parameter_values(problem, grid, footholds, heading, passed)),
    )


def _constraints(
    symbols: Symbols,
    grid: TimeGrid,
    footholds: FootholdIndex,
    problem: PlanningProblem,
    config: VertexZmpConfig,
) -> list[Constraint]:
    return [
        start_state(symbols),
        goal_state(symbols, grid),
        *com_continuity(symbols, grid),
        lip_dynamics(symbols, grid, footholds, problem.model),
        load_sum(symbols),
        load_between_nodes(symbols, grid),
        range_of_motion(symbols, grid, footholds, problem.model, config.reach_margin_m),
    ]


def _lower_bounds(layout: BlockLayout) -> Array:
    """Return the bounds on variables: loads are not negative, Winkler 2017, Eq. (19b)."""
    free = np.array(-np.inf)
    return layout.pack({"com_coefficients": free, "footholds": free, "foot_yaws": free, "loads": np.array(0.0)})


def _parameter_values(
    problem: PlanningProblem,
    grid: TimeGrid,
    footholds: FootholdIndex,
    heading: PiecewisePolynomial,
    passed: slice,
) -> dict[str, Array]:
    start, poses = problem.start, problem.waypoints.poses
    return {
        "start_com": start.com_position[:, None],
        "start_velocity": start.com_velocity[:, None],
        "start_feet": start.feet[:, :2].T,
        "start_yaw": np.array([[start.yaw]]),
        "goal": poses[-1, :2, None],
        "waypoints": poses[passed, :2].T,
        "sample_directions": _directions(heading, range_of_motion_times(grid)),
        "stance_directions": _directions(heading, footholds.free_middles_s),
    }


def _directions(heading: PiecewisePolynomial, times_s: Array) -> Array:
    """Return cos and sin of the heading at ``times_s``, (2, s)."""
    yaw = np.array([heading(float(time))[0] for time in times_s])
    return np.array([np.cos(yaw), np.sin(yaw)])
