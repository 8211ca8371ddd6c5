"""From letters back to words: the unrolled samples as a motion plan."""

import numpy as np

from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array, matrix_to_quat, rotation_zyx
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.kinematic_sqp.program import KinematicProgram
from quadlab.planners.kinematic_sqp.sampled_curve import sampled_curve
from quadlab.planners.kinematic_sqp.unrolling import UnrolledMotion, unroll
from quadlab.planners.plan import UNCHECKED, BaseMotion, MotionPlan, PlanReport
from quadlab.planners.problem import PlanningProblem
from quadlab.robots.legs import LEG_COUNT

_COP_NODES = 6  # a piece of the CoP is the polynomial through so many of its values


def motion_plan(problem: PlanningProblem, program: KinematicProgram, p: Array, report: PlanReport) -> MotionPlan:
    """Return the plan of the iterate ``p``; its verdict is empty until it has been checked."""
    motion = unroll(program.layout, program.grid, p)
    com = sampled_curve(motion.times_s, motion.com)
    return MotionPlan(
        schedule=problem.schedule,
        com=com,
        heading=sampled_curve(motion.times_s, motion.base_rotations[:, :1]),
        cop=centre_of_pressure(com, problem.model.gravity),
        footholds=_footholds(problem, motion),
        report=report,
        verdict=UNCHECKED,
        base=_base_motion(motion),
    )


def centre_of_pressure(com: PiecewisePolynomial, gravity: float) -> PiecewisePolynomial:
    """Return the CoP that an inverted pendulum needs for the CoM's motion, Eq. (7), d = 2.

    On each piece it is a quotient of polynomials, here the polynomial through its values at Chebyshev nodes; the
    vertical acceleration is so small that the difference is far below a micrometre.

    Args:
        com: d = 3.
        gravity: in [m/s^2].
    """
    pieces = len(com.knots) - 1
    nodes = 0.5 - 0.5 * np.cos(np.pi * (np.arange(_COP_NODES) + 0.5) / _COP_NODES)
    durations = np.diff(com.knots)
    index = np.repeat(np.arange(pieces), _COP_NODES)
    local = (durations[:, None] * nodes).ravel()
    position, acceleration = com.on_pieces(index, local), com.on_pieces(index, local, 2)
    lever = position[:, 2] / (acceleration[:, 2] + gravity)
    values = (position[:, :2] - lever[:, None] * acceleration[:, :2]).reshape(pieces, _COP_NODES, 2)
    scaled = np.linalg.solve(np.vander(nodes, increasing=True), values)
    return PiecewisePolynomial(com.knots, scaled / durations[:, None, None] ** np.arange(_COP_NODES)[None, :, None])


def _footholds(problem: PlanningProblem, motion: UnrolledMotion) -> tuple[Array, ...]:
    """Return per leg (swings + 1, 3): the given start, then where the foot is when each swing ends."""
    return tuple(_footholds_of(leg, problem.schedule, problem.start.feet[leg], motion) for leg in range(LEG_COUNT))


def _footholds_of(leg: int, schedule: ContactSchedule, start: Array, motion: UnrolledMotion) -> Array:
    ends = np.array([swing.end_s for swing in schedule.swings[leg]])
    nearest = np.abs(motion.times_s[None, :] - ends[:, None]).argmin(axis=1) if len(ends) else np.zeros(0, dtype=int)
    footholds = np.zeros((len(ends) + 1, 3))
    footholds[0] = start
    footholds[1:, :2] = motion.feet[nearest, leg]
    return footholds


def _base_motion(motion: UnrolledMotion) -> BaseMotion:
    quats = [matrix_to_quat(rotation_zyx(*(float(angle) for angle in rotation))) for rotation in motion.base_rotations]
    return BaseMotion(motion.times_s, motion.base_positions, np.array(quats))
