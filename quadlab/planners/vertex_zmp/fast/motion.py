"""From letters back to words: the solution of the reduced program as a motion plan."""

import numpy as np

from quadlab.geometry.lip_curve import LipCurve
from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.plan import UNCHECKED, MotionPlan, PlanReport
from quadlab.planners.vertex_zmp.fast.model import ReducedModel


def motion_plan(model: ReducedModel, vector: Array, report: PlanReport) -> MotionPlan:
    """Return the plan of a vector of all quantities; its verdict is empty until it has been checked."""
    return MotionPlan(
        schedule=model.problem.schedule,
        com=_com(model, vector),
        heading=model.heading,
        cop=_centre_of_pressure(model, vector),
        footholds=_footholds(model, vector),
        report=report,
        verdict=UNCHECKED,
    )


def _com(model: ReducedModel, vector: Array) -> LipCurve:
    """Return the exact pendulum motion: c = u_0 + b s + p cosh(w s) + q sinh(w s) in each interval."""
    intervals = np.arange(model.grid.count)
    states = vector[model.knot_columns(intervals)]
    ends = [model.spline.cop_weights(intervals, np.full(len(intervals), share)) for share in (0.0, 1.0)]
    start, end = (np.einsum("nj,nja->na", weights, states) for weights in ends)
    slope = (end - start) / model.grid.durations_s[:, None]
    coefficients = np.zeros((len(intervals), 4, 3))
    coefficients[:, :, :2] = np.stack(
        [start, slope, states[:, 0] - start, (states[:, 1] - slope) / model.spline.rate], axis=1
    )
    coefficients[:, 0, 2] = model.problem.model.com_height
    return LipCurve(model.grid.knots_s, coefficients, model.spline.rate)


def _centre_of_pressure(model: ReducedModel, vector: Array) -> PiecewisePolynomial:
    """Return the CoP, Eq. (17): a straight line between the load nodes of each interval."""
    columns, contacts = model.columns, model.grid.node_contacts
    loads = np.where(columns.shared, vector[columns.loads], 0.0)
    loads[np.arange(len(loads)), columns.last_feet] = 1.0 - loads.sum(axis=1)
    stances = vector[columns.stances][model.footholds.phase_stances[model.grid.node_phases]]
    cop = np.einsum("nf,nfa->na", np.where(contacts, loads, 0.0), stances)
    start, end = cop[model.grid.nodes[:, 0]], cop[model.grid.nodes[:, 1]]
    slope = (end - start) / model.grid.durations_s[:, None]
    return PiecewisePolynomial(model.grid.knots_s, np.stack([start, slope], axis=1))


def _footholds(model: ReducedModel, vector: Array) -> tuple[Array, ...]:
    """Return per foot (swings + 1, 3): the given start, then footholds on the ground."""
    stances = np.zeros((model.footholds.count, 3))
    stances[:, :2] = vector[model.columns.stances]
    stances[model.footholds.first] = model.problem.start.feet
    return tuple(np.split(stances, model.footholds.first[1:]))
