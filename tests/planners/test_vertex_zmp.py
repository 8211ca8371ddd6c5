"""What the vertex-ZMP planner promises."""

from dataclasses import replace

import numpy as np
import pytest
from planning_cases import COMMANDS, MODELS, plan, planner, problem, solved, standing

from quadlab.errors import PlanningProblemError
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array, rotation_2d
from quadlab.planners.command import PerStrideCommand
from quadlab.planners.plan import MotionPlan
from quadlab.planners.planner import PlanningStatus
from quadlab.planners.problem import PlanningProblem, Waypoints

MIRROR = [1, 0, 3, 2]  # left legs become right legs


def plan_of(robot: str, gait_name: str, command: str) -> MotionPlan:
    found = solved(robot, gait_name, command)
    assert found.plan is not None, found.reason
    return found.plan


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("gait_name", ["trot", "walk"])
@pytest.mark.parametrize("robot", MODELS)
def test_plans_are_solved_and_accepted_by_the_checker(robot: str, gait_name: str, command: str) -> None:
    outcome = solved(robot, gait_name, command)
    assert outcome.status is PlanningStatus.SOLVED, outcome.reason
    assert outcome.plan is not None
    assert outcome.plan.verdict.accepted
    assert outcome.plan.verdict.values
    assert max(outcome.plan.report.residuals.values()) < 1e-6


@pytest.mark.parametrize("command", ["forward", "turn", "diagonal"])
def test_final_feet_stand_nominally_around_the_goal(command: str) -> None:
    motion = plan_of("anymal", "trot", command)
    goal = problem("anymal", "trot", COMMANDS[command]).waypoints.poses[-1]
    nominal = goal[:2] + MODELS["anymal"].nominal_feet @ rotation_2d(float(goal[2])).T
    final = np.array([footholds[-1, :2] for footholds in motion.footholds])
    np.testing.assert_allclose(final, nominal, atol=0.01)


@pytest.mark.parametrize("robot", MODELS)
def test_steps_of_a_long_trot_are_regular(robot: str) -> None:
    motion = plan(problem(robot, "trot", COMMANDS["forward"], duration_s=7.0)).plan
    assert motion is not None
    for footholds in motion.footholds:
        np.testing.assert_allclose(np.diff(footholds[:, 0])[1:-1], 0.2, atol=0.03)
        np.testing.assert_allclose(np.diff(footholds[:, 1]), 0.0, atol=0.02)


@pytest.mark.parametrize("robot", MODELS)
def test_trotting_in_place_leaves_the_com_where_it_is(robot: str) -> None:
    motion = plan_of(robot, "trot", "in_place")
    com = np.array([motion.com(t)[:2] for t in np.linspace(0.0, motion.duration_s, 200)])
    assert np.abs(com).max() < 1e-4
    for footholds in motion.footholds:
        np.testing.assert_allclose(footholds, footholds[[0]].repeat(len(footholds), axis=0), atol=1e-4)


def test_walking_in_place_sways_and_returns() -> None:
    motion = plan_of("anymal", "walk", "in_place")
    com = np.array([motion.com(t)[:2] for t in np.linspace(0.0, motion.duration_s, 200)])
    assert np.ptp(com[:, 1]) > 0.02
    np.testing.assert_allclose(com[-1], 0.0, atol=1e-6)


@pytest.mark.parametrize("gait_name", ["trot", "walk"])
def test_mirrored_schedule_gives_mirrored_plan(gait_name: str) -> None:
    original = problem("anymal", gait_name, COMMANDS["forward"])
    schedule = ContactSchedule(original.schedule.durations_s, original.schedule.contacts[:, MIRROR])
    mirrored = plan(replace(original, schedule=schedule)).plan
    motion = plan_of("anymal", gait_name, "forward")
    assert mirrored is not None
    for time in np.linspace(0.0, motion.duration_s, 50):
        np.testing.assert_allclose(mirrored.com(time), motion.com(time) * [1, -1, 1], atol=1e-5)
    for leg, other in enumerate(MIRROR):
        np.testing.assert_allclose(mirrored.footholds[leg], motion.footholds[other] * [1, -1, 1], atol=1e-5)


def test_plan_does_not_depend_on_where_the_world_has_its_origin() -> None:
    original = problem("anymal", "trot", COMMANDS["turn"])
    moved = plan(displaced(original, np.array([3.0, -2.0]), 0.7)).plan
    motion = plan_of("anymal", "trot", "turn")
    assert moved is not None
    for leg in range(4):
        expected = motion.footholds[leg][:, :2] @ rotation_2d(0.7).T + [3.0, -2.0]
        np.testing.assert_allclose(moved.footholds[leg][:, :2], expected, atol=1e-5)


def displaced(original: PlanningProblem, shift: Array, angle: float) -> PlanningProblem:
    turn, start = rotation_2d(angle), original.start
    feet = np.column_stack([start.feet[:, :2] @ turn.T + shift, start.feet[:, 2]])
    poses = np.column_stack([original.waypoints.poses[:, :2] @ turn.T + shift, original.waypoints.poses[:, 2] + angle])
    return replace(
        original,
        start=replace(start, com_position=turn @ start.com_position + shift, yaw=angle, feet=feet),
        waypoints=Waypoints(original.waypoints.times_s, poses),
    )


@pytest.mark.parametrize(
    ("speed_m_s", "status"), [(0.5, PlanningStatus.SOLVED), (1.5, PlanningStatus.INFEASIBLE)], ids=["inside", "outside"]
)
def test_standing_robot_stops_only_if_its_capture_point_is_in_the_support(
    speed_m_s: float, status: PlanningStatus
) -> None:
    """Capture point c + v sqrt(h / g), Winkler 2017, Eq. (28) corrected: 0.11 m and 0.33 m, front feet at 0.28 m."""
    still = problem("anymal", "stand", COMMANDS["in_place"])
    pushed = replace(still, start=standing(still.model, np.array([speed_m_s, 0.0])))
    assert plan(pushed).status is status


def test_robustness_cost_moves_the_cop_away_from_the_edges() -> None:
    walk = problem("anymal", "walk", COMMANDS["forward"])
    even = plan(walk, com_acceleration_weight=0.0, robustness_weight=1.0).plan
    calm = plan(walk, com_acceleration_weight=1.0, robustness_weight=0.0).plan
    assert even is not None
    assert calm is not None
    times = np.linspace(0.0, even.duration_s, 300)
    sway = [np.ptp([motion.cop(t)[1] for t in times]) for motion in (even, calm)]
    effort = [np.sum([motion.com(t, 2) ** 2 for t in times]) for motion in (even, calm)]
    assert sway[0] > sway[1]
    assert effort[0] > effort[1]


def test_unreachable_goals_are_an_outcome_that_names_constraints() -> None:
    near = plan(problem("anymal", "trot", PerStrideCommand(kind="per_stride", x_m=1.0, y_m=0.0, yaw_deg=0.0)))
    far = plan(problem("anymal", "trot", PerStrideCommand(kind="per_stride", x_m=50.0, y_m=0.0, yaw_deg=0.0)))
    assert near.status is far.status is PlanningStatus.INFEASIBLE
    assert near.plan is far.plan is None
    assert "goal_state" in near.reason or "range_of_motion" in near.reason
    assert "range_of_motion" in far.reason


def test_iteration_limit_is_an_outcome() -> None:
    outcome = plan(problem("anymal", "walk", COMMANDS["forward"]), max_iterations=2)
    assert outcome.status is PlanningStatus.SOLVER_LIMIT
    assert "limit of iterations" in outcome.reason
    assert "load_balance_m" in outcome.reason or "range_of_motion_m" in outcome.reason


def test_rejection_by_the_checker_is_an_outcome() -> None:
    settings = planner().config.checker.model_dump() | {"dynamics_defect_m_s2": 0.0}
    outcome = plan(problem("anymal", "trot", COMMANDS["forward"]), checker=settings)
    assert outcome.status is PlanningStatus.REJECTED
    assert "dynamics_defect_m_s2" in outcome.reason


def test_malformed_problem_raises_on_build() -> None:
    trot = problem("anymal", "trot", COMMANDS["forward"])
    with pytest.raises(PlanningProblemError, match="NaN"):
        planner().build(replace(trot, start=standing(trot.model, np.array([np.nan, 0.0]))))
