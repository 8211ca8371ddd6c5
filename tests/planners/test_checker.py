"""The checker accepts what holds and names what does not."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from planning_cases import COMMANDS, planner, problem, solved

from quadlab.errors import PlanningProblemError
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.curve import Curve
from quadlab.geometry.lip_curve import LipCurve
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.checker import check_plan
from quadlab.planners.plan import MotionPlan, PlanVerdict


def judged(motion: MotionPlan) -> PlanVerdict:
    return check_plan(motion, problem("anymal", "trot", COMMANDS["turn"]), planner().config.checker)


def good_plan() -> MotionPlan:
    motion = solved("anymal", "trot", "turn").plan
    assert motion is not None
    return motion


def bent(curve: Curve, piece: int | slice, power: int, axis: int, by: float) -> Curve:
    """Return a curve with one coefficient changed; powers beyond a pendulum's straight line bend it as well."""
    assert isinstance(curve, PiecewisePolynomial | LipCurve)
    coefficients = curve.coefficients.copy()
    coefficients[piece, power, axis] += by
    return replace(curve, coefficients=coefficients)


def moved_foothold(motion: MotionPlan, stance: int, axis: int, by: float) -> MotionPlan:
    footholds = tuple(rows.copy() for rows in motion.footholds)
    footholds[0][stance, axis] += by
    return replace(motion, footholds=footholds)


EVERY = slice(None)
DOCTORS: dict[str, Callable[[MotionPlan], MotionPlan]] = {
    "dynamics_defect_m_s2": lambda m: replace(m, com=bent(m.com, 12, 0, 0, 0.05)),
    "com_height_miss_mm": lambda m: replace(m, com=bent(m.com, 12, 0, 2, 1e-3)),
    "cop_outside_mm": lambda m: replace(m, cop=bent(m.cop, 12, 0, 1, 1e-3)),
    "reach_outside_mm": lambda m: moved_foothold(m, 1, 1, 0.15),
    "com_jump_mm": lambda m: replace(m, com=bent(m.com, 12, 0, 0, 1e-3)),
    "com_velocity_jump_mm_s": lambda m: replace(m, com=bent(m.com, 12, 1, 0, 1e-3)),
    "heading_jump_mrad": lambda m: replace(m, heading=bent(m.heading, 2, 0, 0, 1e-3)),
    "heading_rate_jump_mrad_s": lambda m: replace(m, heading=bent(m.heading, 2, 1, 0, 1e-3)),
    "start_miss_mm": lambda m: replace(m, com=bent(m.com, EVERY, 0, 0, 1e-3)),
    "start_velocity_miss_mm_s": lambda m: replace(m, com=bent(m.com, 0, 1, 0, 1e-3)),
    "start_foot_miss_mm": lambda m: moved_foothold(m, 0, 0, 1e-3),
    "goal_miss_mm": lambda m: replace(m, com=bent(m.com, -1, 0, 1, 1e-3)),
    "goal_velocity_mm_s": lambda m: replace(m, com=bent(m.com, -1, 1, 0, 1e-3)),
    "goal_heading_miss_mrad": lambda m: replace(m, heading=bent(m.heading, -1, 0, 0, 1e-3)),
}


def test_every_value_has_a_doctor() -> None:
    assert set(judged(good_plan()).values) == set(DOCTORS)


@pytest.mark.parametrize("name", DOCTORS)
def test_doctored_plan_is_rejected_by_name(name: str) -> None:
    assert judged(good_plan()).accepted
    assert name in judged(DOCTORS[name](good_plan())).violated


@pytest.mark.parametrize("curve", ["com", "cop", "heading"])
def test_not_a_number_is_a_violation(curve: str) -> None:
    motion = good_plan()
    holes: dict[str, Any] = {curve: bent(getattr(motion, curve), 3, 0, 0, np.nan)}
    holed = replace(motion, **holes)
    assert not judged(holed).accepted


def test_load_on_a_swinging_foot_is_found() -> None:
    """The CoP in the middle of all four feet is fine in stance but not on a diagonal far from it."""
    motion = good_plan()
    assert "cop_outside_mm" in judged(moved_foothold(motion, 1, 0, 0.05)).violated


def test_violation_between_knots_is_found() -> None:
    """A bump that vanishes at both ends and in the middle of a polynomial: 16 s^2 (1 - s)^2 (1 - 2 s)^2."""
    motion = good_plan()
    bump = 16.0 * 0.002 * np.array([0.0, 0.0, 1.0, -6.0, 13.0, -12.0, 4.0])
    assert isinstance(motion.cop, PiecewisePolynomial)
    given = motion.cop.coefficients
    coefficients = np.zeros((len(given), 7, 2))
    coefficients[:, : given.shape[1]] = given
    duration = motion.cop.knots[13] - motion.cop.knots[12]
    coefficients[12, :, 0] += bump / duration ** np.arange(7)
    assert "cop_outside_mm" in judged(replace(motion, cop=PiecewisePolynomial(motion.cop.knots, coefficients))).violated


def test_other_schedule_is_refused() -> None:
    motion = good_plan()
    schedule = ContactSchedule(motion.schedule.durations_s, ~motion.schedule.contacts)
    with pytest.raises(PlanningProblemError, match="schedule"):
        judged(replace(motion, schedule=schedule))
