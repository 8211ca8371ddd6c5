"""The capture point is the special case of the planning problem with one foot, one step and one CoP."""

import numpy as np
import pytest
from planning_cases import planner

from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.planners.capture_point import capture_point
from quadlab.planners.planner import PlanningOutcome, PlanningStatus
from quadlab.planners.problem import PlanningModel, PlanningProblem, PlanStart, Waypoints

TWO_FEET = PlanningModel(com_height=0.6, nominal_feet=np.zeros((2, 2)), reach=np.array([1.0, 1.0]))
START = np.array([0.2, -0.1])  # [m] CoM, above the first foot
SWING_S, SETTLING_S = 0.1, 5.0  # the last sway is 2e-9 of the first
RATE = np.sqrt(9.81 / 0.6)  # [1/s]
FREE = dict.fromkeys(
    ("robustness_weight", "com_acceleration_weight", "nominal_foothold_weight", "waypoint_weight"), 0.0
)
VELOCITIES = [np.array([0.3, 0.0]), np.array([0.0, -0.5]), np.array([0.4, 0.7])]


def one_step(velocity: Array, goal: Array) -> PlanningOutcome:
    """Ask for rest at ``goal`` with one step: the pendulum turns about the first foot, then about the second only."""
    schedule = ContactSchedule(np.array([SWING_S, SETTLING_S]), np.array([[True, False], [False, True]]))
    start = PlanStart(START, velocity, 0.0, np.array([[*START, 0.0], [*START, 0.0]]))
    path = np.array([[*START, 0.0], [*goal, 0.0]])
    problem = PlanningProblem(start, Waypoints(np.array([0.0, schedule.duration_s]), path), schedule, TWO_FEET)
    vertex_zmp = planner(**FREE)
    return vertex_zmp.solve(vertex_zmp.build(problem))


def at_touch_down(velocity: Array) -> tuple[Array, Array]:
    """Return CoM and velocity after turning about the first foot, in closed form."""
    even, odd = np.cosh(RATE * SWING_S), np.sinh(RATE * SWING_S)
    return START + velocity / RATE * odd, velocity * even


@pytest.mark.parametrize("velocity", VELOCITIES, ids=str)
def test_planner_steps_on_the_capture_point(velocity: Array) -> None:
    expected = capture_point(*at_touch_down(velocity), 0.6)
    outcome = one_step(velocity, expected)
    assert outcome.plan is not None, outcome.reason
    np.testing.assert_allclose(outcome.plan.footholds[1][1, :2], expected, atol=1e-6)


@pytest.mark.parametrize("velocity", VELOCITIES, ids=str)
def test_one_step_cannot_stop_anywhere_else(velocity: Array) -> None:
    elsewhere = capture_point(*at_touch_down(velocity), 0.6) + np.array([0.01, 0.0])
    assert one_step(velocity, elsewhere).status is not PlanningStatus.SOLVED


@pytest.mark.parametrize("velocity", VELOCITIES, ids=str)
def test_pendulum_comes_to_rest_above_the_capture_point(velocity: Array) -> None:
    foot = capture_point(START, velocity, 0.6)
    for time in (0.1, 0.5, 4.0):
        com = foot + (START - foot) * np.cosh(RATE * time) + velocity / RATE * np.sinh(RATE * time)
        np.testing.assert_allclose(com, foot + (START - foot) * np.exp(-RATE * time), atol=1e-6)
