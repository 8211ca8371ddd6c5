"""The judge of every plan: evaluates it on a dense grid, without looking at how it was made."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.errors import PlanningProblemError
from quadlab.geometry.polygons import convex_hull
from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.plan import MotionPlan, PlanVerdict
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.swing import swing_blend
from quadlab.robots.legs import LEGS

_MILLI = 1e3
_KNOT_TOLERANCE = 1e-9  # [s] knots closer than this are one
IndexArray = NDArray[np.intp]


class CheckerConfig(StrictModel):
    """Tolerances of the checker; a plan above any of them is rejected.

    Attributes:
        sample_period_s: largest distance of the samples in [s]; knots are sampled from both sides besides.
        dynamics_defect_m_s2: |c_ddot - g / h (c - u)| in [m/s^2].
        cop_outside_mm: CoP outside the hull of the feet in contact in [mm].
        reach_outside_mm: a foot, standing or swinging, outside its box in [mm].
        com_height_miss_mm: CoM height off the height of the model in [mm].
        com_jump_mm, com_velocity_jump_mm_s: CoM discontinuity at knots in [mm], [mm/s].
        heading_jump_mrad, heading_rate_jump_mrad_s: heading discontinuity at knots in [mrad], [mrad/s].
        start_miss_mm, start_velocity_miss_mm_s, start_foot_miss_mm: difference to the given start in [mm], [mm/s].
        goal_miss_mm, goal_velocity_mm_s, goal_heading_miss_mrad: CoM and heading at the end in [mm], [mm/s], [mrad].
    """

    sample_period_s: Positive
    dynamics_defect_m_s2: NonNegative
    cop_outside_mm: NonNegative
    reach_outside_mm: NonNegative
    com_height_miss_mm: NonNegative
    com_jump_mm: NonNegative
    com_velocity_jump_mm_s: NonNegative
    heading_jump_mrad: NonNegative
    heading_rate_jump_mrad_s: NonNegative
    start_miss_mm: NonNegative
    start_velocity_miss_mm_s: NonNegative
    start_foot_miss_mm: NonNegative
    goal_miss_mm: NonNegative
    goal_velocity_mm_s: NonNegative
    goal_heading_miss_mrad: NonNegative


@dataclass(frozen=True)
class _Samples:
    """Dense times; ``inside`` lies in the open interval between knots to which each of them belongs, both (s,)."""

    times: Array
    inside: Array


def check_plan(plan: MotionPlan, problem: PlanningProblem, config: CheckerConfig) -> PlanVerdict:
    """Return the worst violation of everything a plan promises.

    Args:
        plan: the plan; its own verdict is ignored.
        problem: what was asked for.
        config: tolerances and sampling.

    Raises:
        PlanningProblemError: if the plan has not one foothold for each stance of the problem's schedule.
    """
    _require_footholds(plan, problem)
    samples = _dense_samples(plan, config.sample_period_s)
    groups: tuple[Callable[[], dict[str, float]], ...] = (
        lambda: _dynamics(plan, problem, samples),
        lambda: _support(plan, samples),
        lambda: _reach(plan, problem, samples),
        lambda: _smoothness(plan),
        lambda: _start(plan, problem),
        lambda: _goal(plan, problem),
    )
    values = {name: value for group in groups for name, value in group().items()}
    return PlanVerdict(values, {name: float(getattr(config, name)) for name in values})


def _require_footholds(plan: MotionPlan, problem: PlanningProblem) -> None:
    for leg, name in enumerate(LEGS):
        expected = (len(problem.schedule.swings[leg]) + 1, 3)
        if plan.footholds[leg].shape != expected:
            raise PlanningProblemError(
                f"plan.footholds of {name}: shape {plan.footholds[leg].shape}, expected {expected}"
            )


def _dense_samples(plan: MotionPlan, period_s: float) -> _Samples:
    """Return samples between all knots of the plan, each interval with both of its ends."""
    knots = np.sort(
        np.concatenate([plan.com.knots, plan.cop.knots, plan.heading.knots, plan.schedule.switch_times_s])
    )
    knots = knots[np.r_[True, np.diff(knots) > _KNOT_TOLERANCE]]
    counts = np.ceil(np.diff(knots) / period_s).astype(int) + 1
    times = [np.linspace(a, b, count) for a, b, count in zip(knots[:-1], knots[1:], counts, strict=True)]
    return _Samples(np.concatenate(times), np.repeat(0.5 * (knots[:-1] + knots[1:]), counts))


def _evaluate(curve: PiecewisePolynomial, samples: _Samples, derivative: int = 0) -> Array:
    """Return a curve or its derivative at all samples, (s, d)."""
    piece = np.clip(np.searchsorted(curve.knots, samples.inside) - 1, 0, len(curve.knots) - 2)
    local = np.clip(samples.times, curve.knots[0], curve.knots[-1]) - curve.knots[piece]
    return _horner(_differentiate(curve.coefficients, derivative)[piece], local)


def _differentiate(coefficients: Array, derivative: int) -> Array:
    for _ in range(derivative):
        coefficients = coefficients[:, 1:] * np.arange(1, coefficients.shape[1])[None, :, None]
    return coefficients


def _horner(coefficients: Array, local: Array) -> Array:
    """Return polynomials (s, degree + 1, d) at local times (s,), (s, d)."""
    value = coefficients[:, -1]
    for power in range(coefficients.shape[1] - 2, -1, -1):
        value = value * local[:, None] + coefficients[:, power]
    return value


def _dynamics(plan: MotionPlan, problem: PlanningProblem, samples: _Samples) -> dict[str, float]:
    model = problem.model
    com, acceleration = _evaluate(plan.com, samples), _evaluate(plan.com, samples, 2)
    fall = model.gravity / model.com_height * (com[:, :2] - _evaluate(plan.cop, samples))
    return {
        "dynamics_defect_m_s2": _largest_norm(acceleration[:, :2] - fall),
        "com_height_miss_mm": _MILLI * float(np.abs(com[:, 2] - model.com_height).max()),
    }


def _support(plan: MotionPlan, samples: _Samples) -> dict[str, float]:
    cop = _evaluate(plan.cop, samples)
    switches = plan.schedule.switch_times_s
    worst = [0.0]
    for phase, contacts in enumerate(plan.schedule.contacts):
        middle = 0.5 * float(switches[phase] + switches[phase + 1])
        counts = [plan.schedule.swing_at(leg, middle)[0] for leg in range(len(LEGS))]
        corners = np.array([plan.footholds[leg][counts[leg], :2] for leg in np.flatnonzero(contacts)])
        held = (samples.inside > switches[phase]) & (samples.inside < switches[phase + 1])
        worst.append(float(distances_outside(cop[held], corners).max()))
    return {"cop_outside_mm": _MILLI * float(np.max(worst))}


def distances_outside(points: Array, corners: Array) -> Array:
    """Return how far each of ``points`` (s, 2) lies outside the hull of ``corners`` (n, 2), (s,) in [m]; 0 inside."""
    hull = convex_hull(corners)
    edges = np.roll(hull, -1, axis=0) - hull
    relative = points[:, None, :] - hull[None]
    length_squared = np.maximum((edges**2).sum(axis=1), 1e-300)
    share = np.clip((relative * edges).sum(axis=2) / length_squared, 0.0, 1.0)
    distance: Array = np.linalg.norm(relative - share[:, :, None] * edges, axis=2).min(axis=1)
    turn = edges[:, 0] * relative[:, :, 1] - edges[:, 1] * relative[:, :, 0]
    inside = (turn >= 0.0).all(axis=1) & (len(hull) >= 3)
    return np.where(inside, 0.0, distance)


def _reach(plan: MotionPlan, problem: PlanningProblem, samples: _Samples) -> dict[str, float]:
    com = _evaluate(plan.com, samples)[:, :2]
    yaw = _evaluate(plan.heading, samples)[:, 0]
    cosine, sine = np.cos(yaw), np.sin(yaw)
    worst = [0.0]
    for leg in range(len(LEGS)):
        relative = _foot_positions(plan, leg, samples) - com
        forward = cosine * relative[:, 0] + sine * relative[:, 1]
        sideways = cosine * relative[:, 1] - sine * relative[:, 0]
        offset = np.abs(np.stack([forward, sideways], axis=1) - problem.model.nominal_feet[leg])
        worst.append(float((offset - problem.model.reach).max()))
    return {"reach_outside_mm": _MILLI * float(np.max(worst))}


def _foot_positions(plan: MotionPlan, leg: int, samples: _Samples) -> Array:
    """Return one foot at all samples, (s, 2): where it stands or on the cubic (13) between two footholds."""
    footholds = plan.footholds[leg][:, :2]
    swings = plan.schedule.swings[leg]
    starts = np.array([swing.start_s for swing in swings])
    ends = np.array([swing.end_s for swing in swings])
    begun: IndexArray = np.searchsorted(starts, samples.inside)
    landed: IndexArray = np.searchsorted(ends, samples.inside)
    swing = np.minimum(landed, max(len(swings) - 1, 0))
    if not len(swings):
        return footholds[landed]
    fraction = np.clip((samples.times - starts[swing]) / (ends - starts)[swing], 0.0, 1.0)
    blend = np.where(begun > landed, swing_blend(fraction), 0.0)[:, None]
    return (1.0 - blend) * footholds[landed] + blend * footholds[begun]


def _jump(curve: PiecewisePolynomial, derivative: int) -> float:
    """Return the largest discontinuity of a derivative at the inner knots of a curve."""
    if len(curve.knots) < 3:
        return 0.0
    table = _differentiate(curve.coefficients, derivative)
    before = _horner(table[:-1], np.diff(curve.knots)[:-1])
    return _largest_norm(table[1:, 0] - before)


def _smoothness(plan: MotionPlan) -> dict[str, float]:
    return {
        "com_jump_mm": _MILLI * _jump(plan.com, 0),
        "com_velocity_jump_mm_s": _MILLI * _jump(plan.com, 1),
        "heading_jump_mrad": _MILLI * _jump(plan.heading, 0),
        "heading_rate_jump_mrad_s": _MILLI * _jump(plan.heading, 1),
    }


def _start(plan: MotionPlan, problem: PlanningProblem) -> dict[str, float]:
    start = problem.start
    feet = np.array([footholds[0] for footholds in plan.footholds])
    return {
        "start_miss_mm": _MILLI * _largest_norm(plan.com(0.0)[None, :2] - start.com_position),
        "start_velocity_miss_mm_s": _MILLI * _largest_norm(plan.com(0.0, 1)[None, :2] - start.com_velocity),
        "start_foot_miss_mm": _MILLI * _largest_norm(feet - start.feet),
    }


def _goal(plan: MotionPlan, problem: PlanningProblem) -> dict[str, float]:
    end, goal = problem.schedule.duration_s, problem.waypoints.poses[-1]
    last = _Samples(np.array([end]), np.array([end]))
    return {
        "goal_miss_mm": _MILLI * _largest_norm(_evaluate(plan.com, last)[:, :2] - goal[:2]),
        "goal_velocity_mm_s": _MILLI * _largest_norm(_evaluate(plan.com, last, 1)[:, :2]),
        "goal_heading_miss_mrad": _MILLI * abs(float(_evaluate(plan.heading, last)[0, 0] - goal[2])),
    }


def _largest_norm(rows: Array) -> float:
    return float(np.linalg.norm(rows, axis=1).max())
