"""From a problem to a checked plan, and what happens when there is none."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from kinematic_cases import (
    PAPER_MOTIONS,
    ROBOTS,
    WHOLE_MOTIONS,
    Motion,
    beside_path,
    perturbed,
    planner,
    problem,
    robot,
)

from quadlab.errors import PlanningProblemError
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.kinematic_sqp.sampled_curve import sampled_curve
from quadlab.planners.plan_io import load_plan, save_plan
from quadlab.planners.planner import PlanningOutcome, PlanningStatus


def outcome(robot_name: str, motion: Motion) -> PlanningOutcome:
    kinematic = planner()
    return kinematic.solve(kinematic.build(problem(robot_name, motion)))


@pytest.mark.parametrize("robot_name", ROBOTS)
@pytest.mark.parametrize("name", WHOLE_MOTIONS)
def test_whole_motion_is_accepted_by_the_checker(robot_name: str, name: str) -> None:
    found = outcome(robot_name, WHOLE_MOTIONS[name])
    assert found.status is PlanningStatus.SOLVED, found.reason
    assert found.plan is not None
    assert found.plan.verdict.accepted
    assert len(found.plan.report.cost_history) == found.plan.report.iterations + 1
    assert found.plan.base is not None
    last_step = max(swings[-1].end_s for swings in found.plan.schedule.swings)
    assert last_step < found.plan.base.times_s[-1] <= found.plan.duration_s + 1e-9


def test_plan_follows_the_waypoints() -> None:
    motion = WHOLE_MOTIONS["turn"]
    found = outcome("anymal_b", motion)
    assert found.plan is not None
    asked = problem("anymal_b", motion).waypoints
    for time_s, pose in zip(asked.times_s[1:], asked.poses[1:], strict=True):
        assert np.abs(found.plan.com(float(time_s))[:2] - pose[:2]).max() < 0.06
        assert abs(float(found.plan.heading(float(time_s))[0] - pose[2])) < 0.15


def test_repeated_strides_are_equal() -> None:
    found = outcome("anymal_b", WHOLE_MOTIONS["trot"])
    assert found.plan is not None
    steps = np.diff(found.plan.footholds[0], axis=0)[1:-1]
    np.testing.assert_allclose(steps, np.broadcast_to(steps[1], steps.shape), atol=5e-3)
    period, later = 1.6, 2.4  # [s]
    one, other = found.plan.com(period, 1), found.plan.com(later, 1)
    np.testing.assert_allclose(one, other, atol=2e-3)


def test_robot_stands_still_through_long_rests() -> None:
    found = outcome("anymal_b", replace(WHOLE_MOTIONS["trot"], rest_s=4.0))
    assert found.plan is not None, found.reason
    for time_s in np.linspace(0.0, 3.0, 20):
        assert np.abs(found.plan.com(float(time_s))[:2] - found.plan.com(0.0)[:2]).max() < 0.02
    assert np.abs(found.plan.com(found.plan.duration_s - 2.0, 1)).max() == 0.0


def test_plan_survives_the_way_to_disk(tmp_path: Path) -> None:
    found = outcome("anymal_b", WHOLE_MOTIONS["trot"])
    assert found.plan is not None and found.plan.base is not None
    save_plan(found.plan, tmp_path / "kinematic.plan")
    again = load_plan(tmp_path / "kinematic.plan")
    assert again.report == found.plan.report
    assert again.base is not None
    np.testing.assert_array_equal(again.base.positions, found.plan.base.positions)
    np.testing.assert_array_equal(again.base.quats_wxyz, found.plan.base.quats_wxyz)


def test_perturbed_start_is_met_exactly() -> None:
    model = robot("anymal_b")
    kinematic = planner()
    asked = problem("anymal_b", WHOLE_MOTIONS["trot"], perturbed(model, np.random.default_rng(3), 0.5))
    found = kinematic.solve(kinematic.build(asked))
    assert found.plan is not None, found.reason
    np.testing.assert_allclose(found.plan.com(0.0)[:2], asked.start.com_position, atol=1e-9)
    np.testing.assert_allclose(found.plan.com(0.0, 1)[:2], asked.start.com_velocity, atol=1e-9)


def test_robot_beside_its_path_comes_back_to_it() -> None:
    kinematic = planner()
    asked = beside_path(problem("anymal_b", WHOLE_MOTIONS["trot"]), np.array([0.0, 0.06, 0.15]))
    found = kinematic.solve(kinematic.build(asked))
    assert found.plan is not None, found.reason
    end, goal = found.plan.duration_s, asked.waypoints.poses[-1]
    assert abs(float(found.plan.com(end)[1]) - goal[1]) < 0.02
    assert abs(float(found.plan.heading(end)[0]) - goal[2]) < 0.05


def test_open_motion_is_rejected_because_it_does_not_stop() -> None:
    found = outcome("anymal_b", PAPER_MOTIONS["trot"])
    assert found.status is PlanningStatus.REJECTED
    assert "goal_velocity_mm_s" in found.reason


def test_too_long_strides_are_no_plan() -> None:
    kinematic = planner(sqp={"max_iterations": 3})
    asked = problem("anymal_b", replace(WHOLE_MOTIONS["trot"], command=(3.0, 0.0, 0.0)))
    found = kinematic.solve(kinematic.build(asked))
    assert found.plan is None
    assert found.status in {PlanningStatus.REJECTED, PlanningStatus.SOLVER_LIMIT}


def test_iteration_limit_is_a_status() -> None:
    kinematic = planner(sqp={"max_iterations": 2})
    found = kinematic.solve(kinematic.build(problem("anymal_b", PAPER_MOTIONS["walk"])))
    assert found.status is PlanningStatus.SOLVER_LIMIT
    assert "2 iterations" in found.reason
    assert "clock" not in found.reason


def test_reason_says_that_the_clock_ended_it() -> None:
    kinematic = planner(sqp={"max_wall_time_s": 1e-6})
    found = kinematic.solve(kinematic.build(problem("anymal_b", PAPER_MOTIONS["walk"])))
    assert found.status is PlanningStatus.SOLVER_LIMIT
    assert "the clock ended it after 1 iterations, max_wall_time_s 1e-06" in found.reason


def test_contradictory_constraints_are_infeasible() -> None:
    """A start far outside the joint limits and joints too slow to come back within one sample."""
    model = robot("anymal_b")
    state = model.nominal_state()
    joints = state.joint_positions.copy()
    joints[0] += 1.2
    kinematic = planner(joint_speed_radps=0.01)
    asked = problem("anymal_b", PAPER_MOTIONS["trot"], replace(state, joint_positions=joints))
    found = kinematic.solve(kinematic.build(asked))
    assert found.status is PlanningStatus.INFEASIBLE, found.reason
    assert found.plan is None


def test_point_mass_problem_is_refused_in_one_line() -> None:
    asked = problem("anymal_b", WHOLE_MOTIONS["trot"])
    with pytest.raises(PlanningProblemError, match=r"problem\.robot: None"):
        planner().build(replace(asked, robot=None))
    with pytest.raises(PlanningProblemError, match=r"start\.state: None"):
        planner().build(replace(asked, start=replace(asked.start, state=None)))


def test_contradicting_start_is_refused_by_name() -> None:
    asked = problem("anymal_b", WHOLE_MOTIONS["trot"])
    assert asked.start.state is not None
    moved = replace(asked.start.state, position_base_in_world=asked.start.state.position_base_in_world + 0.1)
    with pytest.raises(PlanningProblemError, match=r"start\.com_position"):
        planner().build(replace(asked, start=replace(asked.start, state=moved)))
    holed = replace(asked.start.state, joint_positions=np.full(12, np.nan))
    with pytest.raises(PlanningProblemError, match="NaN"):
        planner().build(replace(asked, start=replace(asked.start, state=holed)))


def test_curve_has_the_accelerations_of_the_samples() -> None:
    """Velocity and acceleration are continuous, also where the sample period jumps, and match finite differences."""
    random = np.random.default_rng(5)
    times = np.concatenate([[0.0], np.cumsum([0.25] * 8 + [0.05] * 10 + [0.1] * 5)])
    points = random.standard_normal((len(times), 2)).cumsum(axis=0)
    curve = sampled_curve(times, points)
    assert isinstance(curve, PiecewisePolynomial)
    for order in range(3):
        ends = curve.on_pieces(np.arange(len(times) - 1), np.diff(times), order)
        starts = curve.on_pieces(np.arange(len(times) - 1), np.zeros(len(times) - 1), order)
        np.testing.assert_allclose(ends[:-1], starts[1:], atol=1e-6 * 10.0 ** (2 * order))
    np.testing.assert_allclose(
        curve(0.05 * 5 + 2.0, 2), (points[14] - 2 * points[13] + points[12]) / 0.05**2, atol=1e-6
    )
    np.testing.assert_allclose(curve(0.0), points[0])
    np.testing.assert_allclose(curve(0.0, 1), (points[1] - points[0]) / 0.25)
