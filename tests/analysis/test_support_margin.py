"""Margins of the centre of pressure, on a square and on a plan."""

from pathlib import Path

import numpy as np
import pytest

from quadlab.analysis.support_margin import edge_distance, standing_feet, support_margins
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.plan import UNCHECKED, MotionPlan, PlanReport
from quadlab.robots.legs import LEG_COUNT
from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions
from quadlab.trials.plan_job import run_plan_job

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


@pytest.mark.parametrize(
    ("point", "distance"), [((0.5, 0.5), 0.5), ((0.9, 0.4), 0.1), ((1.0, 0.3), 0.0), ((1.2, 0.5), -0.2)]
)
def test_distance_is_that_of_the_nearest_edge_and_negative_outside(point: tuple[float, float], distance: float) -> None:
    assert edge_distance(np.array(point), SQUARE) == pytest.approx(distance)


def test_a_checked_walk_keeps_its_centre_of_pressure_inside(tmp_path: Path) -> None:
    config = compose_trial(["gait=walk", "planner=vertex_zmp", "duration_s=8"])
    plan = run_plan_job(config, RunOptions(force=False, results_dir=str(tmp_path))).outcome.plan
    assert plan is not None
    times, margins = support_margins(plan, 0.02)
    assert margins.min() > -1e-3
    assert {len(standing_feet(plan, time)) for time in times} == {3, 4}


def test_a_foot_that_lands_stands_where_it_lands() -> None:
    """It lands after 0.1 s and 0.2 s, whose sum is a little more than 0.3 s in floating point."""
    contacts = np.ones((3, LEG_COUNT), dtype=bool)
    contacts[1, 0] = False
    still = PiecewisePolynomial(np.array([0.0, 0.4]), np.zeros((1, 1, 3)))
    footholds = (np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), *np.zeros((LEG_COUNT - 1, 1, 3)))
    report = PlanReport("none", build_ms=0.0, solve_ms=0.0, iterations=0, variables=0, constraints=0)
    schedule = ContactSchedule(np.array([0.1, 0.2, 0.1]), contacts)
    plan = MotionPlan(schedule, still, still, still, footholds, report, UNCHECKED)
    assert standing_feet(plan, 0.3)[0] == pytest.approx([1.0, 0.0])
