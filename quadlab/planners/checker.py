"""The judge of every plan: evaluates it on a dense grid, without looking at how it was made."""

import numpy as np

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.errors import PlanningProblemError
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.polygons import distances_outside
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan, PlanVerdict
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.sampling import (
    Samples,
    dense_samples,
    evaluate,
    foot_positions,
    largest_jump,
    largest_norm,
    turned_vertices,
)
from quadlab.robots.legs import foot_names

_MILLI = 1e3
_TIME_TOLERANCE = 1e-9  # [s]


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


def check_plan(plan: MotionPlan, problem: PlanningProblem, config: CheckerConfig) -> PlanVerdict:
    """Return the worst violation of everything a plan promises.

    Args:
        plan: the plan; its own verdict is ignored.
        problem: what was asked for.
        config: tolerances and sampling.

    Raises:
        PlanningProblemError: if the plan has not one foothold for each stance of the problem's schedule.
    """
    _require_schedule(plan, problem.schedule)
    knots = [plan.com.knots, plan.cop.knots, plan.heading.knots, problem.schedule.switch_times_s]
    samples = dense_samples(knots, problem.schedule.duration_s, config.sample_period_s)
    values = {
        **_dynamics(plan, problem, samples),
        **_support(plan, problem.model.foot_vertices, samples),
        **_reach(plan, problem, samples),
        **_smoothness(plan),
        **_start(plan, problem),
        **_goal(plan, problem),
    }
    return PlanVerdict(values, {name: float(getattr(config, name)) for name in values})


def _require_schedule(plan: MotionPlan, schedule: ContactSchedule) -> None:
    """Check that the plan follows the contact schedule of the problem, with one foothold a stance."""
    same_contacts = np.array_equal(plan.schedule.contacts, schedule.contacts)
    if not (same_contacts and np.allclose(plan.schedule.durations_s, schedule.durations_s, 0.0, _TIME_TOLERANCE)):
        raise PlanningProblemError("plan.schedule: differs from the schedule of the problem")
    for leg, name in enumerate(foot_names(schedule.contacts.shape[1])):
        expected = (len(schedule.swings[leg]) + 1, 3)
        if plan.footholds[leg].shape != expected:
            raise PlanningProblemError(
                f"plan.footholds of {name}: shape {plan.footholds[leg].shape}, expected {expected}"
            )


def _dynamics(plan: MotionPlan, problem: PlanningProblem, samples: Samples) -> dict[str, float]:
    model = problem.model
    com, acceleration = evaluate(plan.com, samples), evaluate(plan.com, samples, 2)
    fall = model.gravity / model.com_height * (com[:, :2] - evaluate(plan.cop, samples))
    return {
        "dynamics_defect_m_s2": largest_norm(acceleration[:, :2] - fall),
        "com_height_miss_mm": _MILLI * float(np.abs(com[:, 2] - model.com_height).max()),
    }


def _support(plan: MotionPlan, vertices: Array, samples: Samples) -> dict[str, float]:
    cop = evaluate(plan.cop, samples)
    switches = plan.schedule.switch_times_s
    worst = [0.0]
    for phase, contacts in enumerate(plan.schedule.contacts):
        middle = 0.5 * float(switches[phase] + switches[phase + 1])
        corners = np.concatenate([_corners(plan, leg, middle, vertices) for leg in np.flatnonzero(contacts).tolist()])
        held = (samples.inside > switches[phase]) & (samples.inside < switches[phase + 1])
        worst.append(float(distances_outside(cop[held], corners).max()))
    return {"cop_outside_mm": _MILLI * float(np.max(worst))}


def _corners(plan: MotionPlan, leg: int, time_s: float, vertices: Array) -> Array:
    """Return where the vertices of a standing foot are, (v, 2) in [m]."""
    stance = plan.schedule.swing_at(leg, time_s)[0]
    yaw = plan.foot_yaws[leg][stance] if plan.foot_yaws else np.zeros(())
    return plan.footholds[leg][stance, :2] + turned_vertices(vertices, yaw)


def _reach(plan: MotionPlan, problem: PlanningProblem, samples: Samples) -> dict[str, float]:
    com = evaluate(plan.com, samples)[:, :2]
    yaw = evaluate(plan.heading, samples)[:, 0]
    cosine, sine = np.cos(yaw), np.sin(yaw)
    worst = [0.0]
    for leg in range(len(plan.footholds)):
        relative = foot_positions(plan, leg, samples) - com
        forward = cosine * relative[:, 0] + sine * relative[:, 1]
        sideways = cosine * relative[:, 1] - sine * relative[:, 0]
        offset = np.abs(np.stack([forward, sideways], axis=1) - problem.model.nominal_feet[leg])
        worst.append(float((offset - problem.model.reach).max()))
    return {"reach_outside_mm": _MILLI * float(np.max(worst))}


def _smoothness(plan: MotionPlan) -> dict[str, float]:
    return {
        "com_jump_mm": _MILLI * largest_jump(plan.com, 0),
        "com_velocity_jump_mm_s": _MILLI * largest_jump(plan.com, 1),
        "heading_jump_mrad": _MILLI * largest_jump(plan.heading, 0),
        "heading_rate_jump_mrad_s": _MILLI * largest_jump(plan.heading, 1),
    }


def _start(plan: MotionPlan, problem: PlanningProblem) -> dict[str, float]:
    start = problem.start
    feet = np.array([footholds[0] for footholds in plan.footholds])
    return {
        "start_miss_mm": _MILLI * largest_norm(plan.com(0.0)[None, :2] - start.com_position),
        "start_velocity_miss_mm_s": _MILLI * largest_norm(plan.com(0.0, 1)[None, :2] - start.com_velocity),
        "start_foot_miss_mm": _MILLI * largest_norm(feet - start.feet),
    }


def _goal(plan: MotionPlan, problem: PlanningProblem) -> dict[str, float]:
    end, goal = problem.schedule.duration_s, problem.waypoints.poses[-1]
    last = Samples(np.array([end]), np.array([end]))
    return {
        "goal_miss_mm": _MILLI * largest_norm(evaluate(plan.com, last)[:, :2] - goal[:2]),
        "goal_velocity_mm_s": _MILLI * largest_norm(evaluate(plan.com, last, 1)[:, :2]),
        "goal_heading_miss_mrad": _MILLI * abs(float(evaluate(plan.heading, last)[0, 0] - goal[2])),
    }
