"""From words to letters: a planning problem as a bilinear program, a list of named terms."""

from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.heading import heading_spline
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.vertex_zmp.config import VertexZmpConfig
from quadlab.planners.vertex_zmp.fast.assembly import Unknowns, assemble
from quadlab.planners.vertex_zmp.fast.columns import Columns
from quadlab.planners.vertex_zmp.fast.constraints.cop_continuity import cop_continuity
from quadlab.planners.vertex_zmp.fast.constraints.load_balance import load_balance
from quadlab.planners.vertex_zmp.fast.constraints.range_of_motion import range_of_motion
from quadlab.planners.vertex_zmp.fast.constraints.unilateral_load import unilateral_load, unilateral_rest
from quadlab.planners.vertex_zmp.fast.costs.com_acceleration import com_acceleration
from quadlab.planners.vertex_zmp.fast.costs.nominal_foothold import nominal_foothold
from quadlab.planners.vertex_zmp.fast.costs.robustness import robustness
from quadlab.planners.vertex_zmp.fast.costs.waypoint import waypoint
from quadlab.planners.vertex_zmp.fast.model import ReducedModel
from quadlab.planners.vertex_zmp.fast.program import BilinearProgram
from quadlab.planners.vertex_zmp.fast.tension_spline import TensionSpline
from quadlab.planners.vertex_zmp.footholds import FootholdIndex
from quadlab.planners.vertex_zmp.grid import time_grid

NODES_PER_INTERVAL = 2
"""Load nodes at both ends of each interval; loads are linear in time between them."""


@dataclass(frozen=True)
class ReducedTranscription:
    """The reduced program of one problem.

    Attributes:
        model: problem, grid and numbering.
        unknowns: which entries of the vector are unknown.
        program: the bilinear program over the unknowns.
        guess: first iterate, (n,).
    """

    model: ReducedModel
    unknowns: Unknowns
    program: BilinearProgram
    guess: Array

    def vector(self, z: Array) -> Array:
        """Return the vector of all quantities, known and unknown."""
        full = self.unknowns.known.copy()
        full[self.unknowns.index >= 0] = z
        return full


def transcribe(problem: PlanningProblem, config: VertexZmpConfig) -> ReducedTranscription:
    """Return the reduced program of a well-formed problem of point feet."""
    model = reduced_model(problem, config)
    unknowns = _unknowns(model)
    program = assemble(
        unknowns,
        equalities=[load_balance(model), cop_continuity(model)],
        inequalities=[range_of_motion(model, config.reach_margin_m), unilateral_load(model), unilateral_rest(model)],
        costs=[
            (config.robustness_weight, robustness(model)),
            (config.com_acceleration_weight, com_acceleration(model)),
            (config.nominal_foothold_weight, nominal_foothold(model)),
            (config.waypoint_weight, waypoint(model)),
        ],
    )
    return ReducedTranscription(model, unknowns, program, sliding_guess(model)[unknowns.index >= 0])


def reduced_model(problem: PlanningProblem, config: VertexZmpConfig) -> ReducedModel:
    """Return the grid, the numbering and the pendulum of a problem."""
    grid = time_grid(problem.schedule, config.polynomial_duration_s, NODES_PER_INTERVAL)
    footholds = FootholdIndex(problem.schedule)
    return ReducedModel(
        problem=problem,
        heading=heading_spline(problem.waypoints),
        grid=grid,
        footholds=footholds,
        columns=Columns(grid, footholds),
        spline=TensionSpline(grid.durations_s, float(np.sqrt(problem.model.gravity / problem.model.com_height))),
    )


def sliding_guess(model: ReducedModel) -> Array:
    """Return the whole vector for a robot that slides along the waypoints in its nominal stance, equally loaded.

    The paper begins with the robot standing in its default stance; for long horizons this is closer.
    """
    columns, footholds, waypoints = model.columns, model.footholds, model.problem.waypoints
    vector = np.zeros(columns.size)
    path = waypoints.positions_at(model.grid.knots_s)
    vector[columns.states[:, 0]] = path
    vector[columns.states[:, 1]] = np.gradient(path, model.grid.knots_s, axis=0)
    nominal = footholds.nominal_places(model.problem.model.nominal_feet, model.yaw(footholds.free_middles_s))
    vector[columns.stances[footholds.free]] = waypoints.positions_at(footholds.free_middles_s) + nominal
    even = np.broadcast_to(1.0 / model.grid.node_contacts.sum(axis=1, keepdims=True), columns.shared.shape)
    vector[columns.loads[columns.shared]] = even[columns.shared]
    vector[columns.known] = _known_values(model)
    return vector


def _known_values(model: ReducedModel) -> Array:
    """Return the values of ``Columns.known``: the start at its velocity, the goal at rest, the feet at the start."""
    start, goal = model.problem.start, model.problem.waypoints.poses[-1, :2]
    ends = [start.com_position, start.com_velocity, goal, np.zeros(2)]
    return np.concatenate([*ends, start.feet[:, :2].ravel()])


def _unknowns(model: ReducedModel) -> Unknowns:
    columns = model.columns
    free = np.ones(columns.size, dtype=bool)
    free[columns.known] = False
    known = np.zeros(columns.size)
    known[columns.known] = _known_values(model)
    return Unknowns(np.where(free, np.cumsum(free) - 1, -1), known)
