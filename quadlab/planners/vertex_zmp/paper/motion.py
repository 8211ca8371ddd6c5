"""From letters back to words: the solution of the program as a motion plan."""

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.plan import UNCHECKED, MotionPlan, PlanReport
from quadlab.planners.sampling import turned_vertices
from quadlab.planners.vertex_zmp.paper.symbols import COEFFICIENT_COUNT, vertex_contacts
from quadlab.planners.vertex_zmp.paper.transcription import Transcription


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
        foot_yaws=_foot_yaws(transcription, x),
    )


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


def _foot_yaws(transcription: Transcription, x: Array) -> tuple[Array, ...]:
    """Return per foot (swings + 1,) in [rad]; nothing for point feet."""
    footholds = transcription.footholds
    if not transcription.layout.shapes["foot_yaws"][1]:
        return ()
    yaws = np.full(footholds.count, transcription.problem.start.yaw)
    yaws[footholds.free] = transcription.layout.value("foot_yaws", x)[0]
    return tuple(np.split(yaws, footholds.first[1:]))


def _centre_of_pressure(transcription: Transcription, x: Array, stances: Array) -> PiecewisePolynomial:
    """Return the CoP, Eq. (17): over each polynomial the parabola through its three load nodes."""
    grid, footholds = transcription.grid, transcription.footholds
    vertices = transcription.problem.model.foot_vertices
    contacts = vertex_contacts(grid, len(vertices))
    loads = np.zeros(contacts.shape)
    loads[contacts] = transcription.layout.value("loads", x)[:, 0]
    yaws = _foot_yaws(transcription, x)
    numbers = footholds.phase_stances[grid.node_phases]
    angles = np.concatenate(yaws)[numbers] if yaws else np.zeros(numbers.shape)
    corners = stances[numbers][:, :, None] + turned_vertices(vertices, angles)
    cop = np.einsum("nk,nkd->nd", loads, corners.reshape(len(corners), -1, 2))
    start, middle, end = (cop[grid.nodes[:, node]] for node in range(3))
    duration = grid.durations_s[:, None]
    linear = (4.0 * middle - 3.0 * start - end) / duration
    quadratic = 2.0 * (start + end - 2.0 * middle) / duration**2
    return PiecewisePolynomial(grid.knots_s, np.stack([start, linear, quadratic], axis=1))
