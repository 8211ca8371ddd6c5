"""What the ZMP spline planner promises."""

import re
from dataclasses import replace

import numpy as np
import pytest
from planning_cases import COMMANDS, MODELS, problem, standing
from zmp_spline_cases import MARGIN, SETTINGS, solved_walk, spline_plan, spline_planner, walk

from quadlab.errors import PlanningProblemError
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.polygons import convex_hull
from quadlab.geometry.rotations import Array, rotation_2d
from quadlab.planners.plan import MotionPlan
from quadlab.planners.planner import PlanningStatus
from quadlab.planners.problem import Waypoints
from quadlab.planners.sampling import largest_jump

MIRROR = [1, 0, 3, 2]  # left legs become right legs
BETWEEN_SAMPLES = 2e-4  # [m] how far the ZMP may cross the margin where no constraint is written


def walk_plan(robot: str = "anymal", command: str = "forward") -> MotionPlan:
    found = solved_walk(robot, command)
    assert found.plan is not None, found.reason
    return found.plan


def depth_inside(point: Array, corners: Array) -> float:
    """How far a point is inside the nearest edge of a hull, in [m]; negative outside."""
    hull = convex_hull(corners)
    edges = np.roll(hull, -1, axis=0) - hull
    left = np.stack([-edges[:, 1], edges[:, 0]], axis=1) / np.linalg.norm(edges, axis=1)[:, None]
    return float((left * (point - hull)).sum(axis=1).min())


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("robot", MODELS)
def test_walks_are_solved_and_accepted_by_the_checker(robot: str, command: str) -> None:
    outcome = solved_walk(robot, command)
    assert outcome.status is PlanningStatus.SOLVED, outcome.reason
    assert outcome.plan is not None
    assert outcome.plan.verdict.accepted
    report = outcome.plan.report
    assert set(report.residuals) == {"zmp_in_support_m", "range_of_motion_m", "optimality"}
    assert max(report.residuals.values()) < 1e-6
    assert set(report.costs) == {"com_acceleration"}
    assert report.variables > 0
    assert report.constraints > report.variables


@pytest.mark.parametrize("command", ["forward", "turn"])
@pytest.mark.parametrize("robot", MODELS)
def test_zmp_keeps_its_margin_at_all_times(robot: str, command: str) -> None:
    plan = walk_plan(robot, command)
    for time in np.linspace(0.0, plan.duration_s, 3001):
        standing = np.flatnonzero(plan.schedule.contacts_at(time)).tolist()
        feet = [plan.foothold_at(leg, time)[:2] for leg in standing]
        acceleration = plan.com(time, 2)[:2]
        zmp = plan.com(time)[:2] - MODELS[robot].com_height / MODELS[robot].gravity * acceleration
        np.testing.assert_allclose(plan.cop(time), zmp, atol=1e-9)
        assert depth_inside(zmp, np.array(feet)) > MARGIN - BETWEEN_SAMPLES


def test_com_is_smooth_up_to_its_acceleration_and_ends_at_rest_at_the_goal() -> None:
    plan = walk_plan()
    for derivative, tolerance in ((0, 1e-9), (1, 1e-9), (2, 1e-7)):
        assert largest_jump(plan.com, derivative) < tolerance
    end, goal = plan.duration_s, walk().waypoints.poses[-1]
    np.testing.assert_allclose(plan.com(end)[:2], goal[:2], atol=1e-9)
    np.testing.assert_allclose(plan.com(end, 1), 0.0, atol=1e-9)
    np.testing.assert_allclose(plan.com(end, 2), 0.0, atol=1e-7)


def test_start_state_is_met() -> None:
    asked = replace(walk(), start=standing(MODELS["anymal"], np.array([0.05, -0.02])))
    plan = spline_plan(asked).plan
    assert plan is not None
    np.testing.assert_allclose(plan.com(0.0, 1)[:2], [0.05, -0.02], atol=1e-9)


def test_footholds_are_the_nominal_stance_around_the_path() -> None:
    plan, model = walk_plan(command="turn"), MODELS["anymal"]
    goal = walk(command="turn").waypoints.poses[-1]
    final = np.array([footholds[-1, :2] for footholds in plan.footholds])
    np.testing.assert_allclose(final, goal[:2] + model.nominal_feet @ rotation_2d(float(goal[2])).T, atol=1e-12)
    np.testing.assert_allclose([feet[0] for feet in plan.footholds], walk().start.feet)


def test_mirrored_walk_gives_mirrored_plan() -> None:
    schedule = walk().schedule
    mirrored = spline_plan(
        replace(walk(), schedule=ContactSchedule(schedule.durations_s, schedule.contacts[:, MIRROR]))
    )
    assert mirrored.plan is not None
    plan = walk_plan()
    for time in np.linspace(0.0, plan.duration_s, 50):
        np.testing.assert_allclose(mirrored.plan.com(time), plan.com(time) * [1, -1, 1], atol=1e-6)


def test_plan_does_not_depend_on_where_the_world_has_its_origin() -> None:
    asked, turn, shift = walk(command="turn"), rotation_2d(0.7), np.array([3.0, -2.0])
    feet = np.column_stack([asked.start.feet[:, :2] @ turn.T + shift, asked.start.feet[:, 2]])
    poses = np.column_stack([asked.waypoints.poses[:, :2] @ turn.T + shift, asked.waypoints.poses[:, 2] + 0.7])
    start = replace(asked.start, com_position=shift, yaw=0.7, feet=feet)
    moved = spline_plan(replace(asked, start=start, waypoints=Waypoints(asked.waypoints.times_s, poses))).plan
    assert moved is not None
    plan = walk_plan(command="turn")
    for time in np.linspace(0.0, plan.duration_s, 50):
        np.testing.assert_allclose(moved.com(time)[:2], turn @ plan.com(time)[:2] + shift, atol=1e-6)


def test_standing_robot_stays_where_it_is() -> None:
    plan = spline_plan(problem("anymal", "stand", COMMANDS["in_place"])).plan
    assert plan is not None
    assert np.abs([plan.com(t)[:2] for t in np.linspace(0.0, 3.0, 50)]).max() < 1e-9


def test_a_support_without_area_is_infeasible_and_says_so() -> None:
    outcome = spline_plan(problem("anymal", "trot", COMMANDS["forward"]))
    assert outcome.status is PlanningStatus.INFEASIBLE
    assert outcome.plan is None
    assert "zmp_in_support_m" in outcome.reason
    assert "RF, LH" in outcome.reason
    assert "walks" in outcome.reason


def test_soft_support_must_be_asked_for_and_is_judged_all_the_same() -> None:
    """With a price on leaving the support a trot has a motion; the checker accepts it if told how far is too far."""
    trot = problem("anymal", "trot", COMMANDS["forward"])
    soft = {"support_slack_weight": 1e4, "support_margin_m": 0.0}
    strict = spline_plan(trot, **soft)
    assert strict.status is PlanningStatus.REJECTED
    assert "cop_outside_mm" in strict.reason
    lenient = spline_plan(trot, **soft, checker={**SETTINGS["checker"], "cop_outside_mm": 20.0})
    assert lenient.status is PlanningStatus.SOLVED, lenient.reason
    assert lenient.plan is not None
    assert lenient.plan.report.residuals["zmp_in_support_m"] > 0.0


def test_contradiction_names_the_constraints_and_when() -> None:
    """A speed at which the capture point leaves the support."""
    still = problem("anymal", "stand", COMMANDS["in_place"])
    outcome = spline_plan(replace(still, start=standing(still.model, np.array([2.0, 0.0]))))
    assert outcome.status is PlanningStatus.INFEASIBLE
    assert "zmp_in_support_m" in outcome.reason or "range_of_motion_m" in outcome.reason
    assert " s" in outcome.reason


def test_constraints_are_not_said_to_contradict_where_the_solver_has_failed() -> None:
    still = problem("anymal", "stand", COMMANDS["in_place"])
    falling = replace(still, start=standing(still.model, np.array([2.0, 0.0])))
    outcome = spline_plan(falling, optimality_tolerance=1e-300)
    assert outcome.status is PlanningStatus.SOLVER_LIMIT
    assert outcome.reason.startswith("piqp failed: optimality residual ")
    assert "with elastic constraints" in outcome.reason


def test_violated_sets_are_named_in_the_order_of_the_program() -> None:
    """Not in the order of a Python set, which differs from run to run."""
    still = problem("anymal", "stand", COMMANDS["in_place"])
    planner = spline_planner(optimality_tolerance=1e-300)
    built = planner.build(replace(still, start=standing(still.model, np.array([2.0, 0.0]))))
    assert built.program is not None
    names = [f"{letter}_m" for letter in "hgfedcba"]
    bounds = tuple(replace(built.program.bounds[0], name=name) for name in names)
    outcome = planner.solve(replace(built, program=replace(built.program, bounds=bounds)))
    assert re.findall(r"\w_m", outcome.reason) == names


def test_zmp_can_be_drawn_to_the_middle_of_supports_without_area() -> None:
    """Of a trot's two feet, here: the more it counts, the nearer to the point halfway between them."""
    trot = problem("anymal", "trot", COMMANDS["forward"])
    loose = {**SETTINGS["checker"], "cop_outside_mm": 100.0}
    distances = []
    for weight in (0.0, 1e3):
        plan = spline_plan(trot, support_slack_weight=1e4, support_centre_weight=weight, checker=loose).plan
        assert plan is not None
        found = []
        for time in np.linspace(0.0, plan.duration_s, 301):
            legs = np.flatnonzero(plan.schedule.contacts_at(time)).tolist()
            feet = [plan.foothold_at(leg, time)[:2] for leg in legs]
            if len(feet) == 2:
                found.append(float(np.linalg.norm(plan.cop(time) - np.mean(feet, axis=0))))
        distances.append(np.mean(found))
        assert ("support_centre" in plan.report.costs) == (weight > 0.0)
    assert distances[1] < distances[0]


def test_rejection_by_the_checker_is_an_outcome() -> None:
    outcome = spline_plan(walk(), checker={**SETTINGS["checker"], "goal_heading_miss_mrad": 0.0, "com_jump_mm": 0.0})
    assert outcome.status is PlanningStatus.REJECTED
    assert "com_jump_mm" in outcome.reason


def test_malformed_problem_raises_on_build() -> None:
    nowhere = standing(MODELS["anymal"], np.array([np.nan, 0.0]))
    with pytest.raises(PlanningProblemError, match="NaN"):
        spline_planner().build(replace(walk(), start=nowhere))
    no_feet = ContactSchedule(np.array([12.0]), np.zeros((1, 4), dtype=bool))
    with pytest.raises(PlanningProblemError, match="no leg is in contact"):
        spline_planner().build(replace(walk(), schedule=no_feet))
