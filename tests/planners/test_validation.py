"""Malformed problems are refused with one clear line."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from planning_cases import COMMANDS, MODELS, problem

from quadlab.errors import PlanningProblemError
from quadlab.gaits.schedule import ContactSchedule
from quadlab.planners.problem import PlanningProblem, Waypoints
from quadlab.planners.validation import farthest_travel, validate_problem

NAN2 = np.array([np.nan, 0.0])


def with_durations(p: PlanningProblem, durations: list[float]) -> PlanningProblem:
    contacts = np.ones((len(durations), 4), dtype=bool)
    return replace(p, schedule=ContactSchedule(np.array(durations), contacts))


def with_contacts(p: PlanningProblem, contacts: list[list[bool]]) -> PlanningProblem:
    return replace(p, schedule=ContactSchedule(p.schedule.durations_s[: len(contacts)], np.array(contacts)))


def with_times(p: PlanningProblem, change: Callable[[np.ndarray], np.ndarray]) -> PlanningProblem:
    return replace(p, waypoints=Waypoints(change(p.waypoints.times_s), p.waypoints.poses))


MALFORMED: dict[str, tuple[Callable[[PlanningProblem], PlanningProblem], str]] = {
    "nan": (lambda p: replace(p, start=replace(p.start, com_position=NAN2)), "start.com_position: holds NaN"),
    "feet": (lambda p: replace(p, start=replace(p.start, feet=np.zeros((4, 2)))), r"start.feet: has shape \(4, 2\)"),
    "no leg": (lambda p: with_contacts(p, [[True] * 4, [False] * 4]), "no leg is in contact in phase 1"),
    "three legs": (lambda p: with_contacts(p, [[True] * 3] * 2), "columns LF, RF, LH, RH"),
    "zero phase": (lambda p: with_durations(p, [1.0, 0.0, 9.0]), "phase 1 lasts 0 s"),
    "negative phase": (lambda p: with_durations(p, [1.0, -1.0, 9.0]), "phase 1 lasts -1 s"),
    "no phase": (lambda p: with_durations(p, []), "no phase"),
    "height": (lambda p: replace(p, model=replace(p.model, com_height=0.0)), "com_height"),
    "reach": (lambda p: replace(p, model=replace(p.model, reach=np.array([0.2, -0.1]))), "reach"),
    "order": (lambda p: with_times(p, lambda t: t[::-1]), "not increasing"),
    "late": (lambda p: with_times(p, lambda t: 2.0 * t), "expected from 0 to at most 3 s"),
    "count": (lambda p: with_times(p, lambda t: t[:-1]), r"waypoints.poses: has shape"),
    "start": (lambda p: replace(p, start=replace(p.start, yaw=0.1)), "the first pose is"),
}


@pytest.mark.parametrize("case", MALFORMED)
def test_malformed_problem_is_refused(case: str) -> None:
    good = problem("anymal", "trot", COMMANDS["forward"])
    validate_problem(good)
    change, message = MALFORMED[case]
    with pytest.raises(PlanningProblemError, match=message):
        validate_problem(change(good))


def test_standing_feet_bound_the_travel() -> None:
    """Four feet that never move: the CoM cannot leave twice the half diagonal of their boxes."""
    schedule = ContactSchedule(np.array([5.0]), np.ones((1, 4), dtype=bool))
    model = MODELS["anymal"]
    assert farthest_travel(schedule, model, 0.0) == pytest.approx(2.0 * np.hypot(0.20, 0.10))
    assert farthest_travel(schedule, model, 1.0) > farthest_travel(schedule, model, 0.0)
