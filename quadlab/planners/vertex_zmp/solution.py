"""From letters back to words: the solution of the program as a motion plan."""

from dataclasses import replace

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.plan import MotionPlan, PlanReport, PlanVerdict
from quadlab.planners.vertex_zmp.symbols import COEFFICIENT_COUNT
from quadlab.planners.vertex_zmp.transcription import Transcription
from quadlab.robots.legs import LEG_COUNT

UNCHECKED = PlanVerdict({}, {})
"""The verdict of a plan on its way to the checker."""


def motion_plan(transcription: Transcription, x: Array, report: PlanReport) -> MotionPlan:
    """Return the plan of the iterate ``x``; its verdict is empty until it has been checked."""
    stances = _stances(transcription, x)
    return MotionPlan(
        schedule=transcription.problem.schedule,
        com=_com(transcription, x),
        heading=transcription.heading,
        cop=_centre_of_pressure(transcription, x, stances),
        footholds=_footholds(transcription, stances),
        report=report,
        verdict=UNCHECKED,
    )


def with_verdict(plan: MotionPlan, verdict: PlanVerdict) -> MotionPlan:
    """Return the plan with what the checker says about it."""
    return replace(plan, verdict=verdict)


def _com(transcription: Transcription, x: Array) -> PiecewisePolynomial:
    grid = transcription.grid
    block = transcription.layout.value("com_coefficients", x)
    scaled = block.T.reshape(grid.count, COEFFICIENT_COUNT, 2)
    coefficients = np.zeros((grid.count, COEFFICIENT_COUNT, 3))
    coefficients[:, :, :2] = scaled / grid.durations_s[:, None, None] ** np.arange(COEFFICIENT_COUNT)[None, :, None]
    coefficients[:, 0, 2] = transcription.problem.model.com_height
    return PiecewisePolynomial(grid.knots_s, coefficients)


def _stances(transcription: Transcription, x: Array) -> Array:
    """Return the positions of all stances, (M, 2)."""
    footholds = transcription.footholds
    stances = np.empty((footholds.count, 2))
    stances[footholds.first] = transcription.problem.start.feet[:, :2]
    stances[footholds.free] = transcription.layout.value("footholds", x).T
    return stances


def _footholds(transcription: Transcription, stances: Array) -> tuple[Array, ...]:
    """Return per leg (swings + 1, 3): the given start, then footholds on the ground."""
    footholds = []
    for leg, rows in enumerate(np.split(stances, transcription.footholds.first[1:])):
        positions = np.zeros((len(rows), 3))
        positions[:, :2] = rows
        positions[0] = transcription.problem.start.feet[leg]
        footholds.append(positions)
    return tuple(footholds)


def _centre_of_pressure(transcription: Transcription, x: Array, stances: Array) -> PiecewisePolynomial:
    """Return the CoP, Eq. (17): over each polynomial the parabola through its three load nodes."""
    grid, footholds = transcription.grid, transcription.footholds
    loads = np.zeros((len(grid.node_phases), LEG_COUNT))
    loads[grid.node_contacts] = transcription.layout.value("loads", x)[:, 0]
    positions = stances[footholds.phase_stances[grid.node_phases]]
    cop = np.einsum("nf,nfd->nd", loads, positions)
    start, middle, end = (cop[grid.nodes[:, node]] for node in range(3))
    duration = grid.durations_s[:, None]
    linear = (4.0 * middle - 3.0 * start - end) / duration
    quadratic = 2.0 * (start + end - 2.0 * middle) / duration**2
    return PiecewisePolynomial(grid.knots_s, np.stack([start, linear, quadratic], axis=1))
