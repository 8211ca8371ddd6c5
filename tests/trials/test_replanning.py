"""Planning again on the way: the rest of a good plan is found again, a failure changes nothing and is counted."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quadlab.controllers.tracking.handover import PlanProgress
from quadlab.errors import PlanningProblemError
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import rotation_2d
from quadlab.planners.plan import MotionPlan
from quadlab.planners.planner import PlanningOutcome, PlanningStatus
from quadlab.planners.problem import PlanningProblem
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.state import RobotState
from quadlab.trials.compose import compose_trial
from quadlab.trials.planning import build_planner, planning_problem
from quadlab.trials.progress import SilentProgress
from quadlab.trials.replanning import Replanner, ReplanningConfig, remaining_problem, standing_on
from quadlab.trials.result import TrialResult, TrialStatus
from quadlab.trials.runner import run_trial

SHORTEST_PHASE_S = 0.05


@dataclass(frozen=True)
class Planned:
    """A robot, the problem of its trial and the plan."""

    robot: RobotModel
    problem: PlanningProblem
    planner: Any
    plan: MotionPlan


@pytest.fixture(scope="module")
def trot() -> Planned:
    return planned("gait=trot", "duration_s=4")


def planned(*overrides: str) -> Planned:
    config = compose_trial(overrides)
    robot, planner = load_robot(config.robot), build_planner(config)
    problem = planning_problem(config, robot, robot.nominal_state())
    plan = planner.solve(planner.build(problem)).plan
    assert plan is not None
    return Planned(robot, problem, planner, plan)


def planned_state(motion: Planned, time_s: float) -> RobotState:
    """The nominal posture with position and velocity of the planned CoM."""
    nominal, sample = motion.robot.nominal_state(), motion.plan.at(time_s)
    shift = sample.com_position[:2] - motion.robot.kinematics(nominal).com_position[:2]
    return replace(
        nominal,
        time_s=time_s,
        position_base_in_world=nominal.position_base_in_world + np.array([*shift, 0.0]),
        linear_velocity_base_in_world=np.array([*sample.com_velocity[:2], 0.0]),
    )


def planned_progress(plan: MotionPlan, time_s: float) -> PlanProgress:
    swings = [plan.schedule.swing_at(leg, time_s) for leg in range(4)]
    feet = np.array([plan.footholds[leg][completed] for leg, (completed, _) in enumerate(swings)])
    return PlanProgress(time_s, np.zeros(3), feet, np.array([swing is None for _, swing in swings]), True)


@pytest.mark.parametrize("share", [0.0, 0.5], ids=["at a switch", "in a swing"])
@pytest.mark.parametrize("phase", [1, 3, 5])
def test_planning_from_the_planned_state_gives_the_rest_of_the_plan(trot: Planned, phase: int, share: float) -> None:
    switches = trot.plan.schedule.switch_times_s
    cut_s = float(switches[phase] + share * (switches[phase + 1] - switches[phase]))
    state = planned_state(trot, cut_s)
    rest = remaining_problem(trot.problem, planned_progress(trot.plan, cut_s), trot.robot, state, SHORTEST_PHASE_S)
    again = trot.planner.solve(trot.planner.build(rest)).plan
    assert again is not None
    assert again.duration_s == pytest.approx(trot.plan.duration_s - cut_s)
    for time in np.linspace(0.0, again.duration_s, 60):
        np.testing.assert_allclose(again.com(time)[:2], trot.plan.com(cut_s + time)[:2], atol=2e-3)
    for leg in range(4):
        later = trot.plan.footholds[leg][-len(again.footholds[leg]) :]
        np.testing.assert_allclose(again.footholds[leg][:, :2], later[:, :2], atol=5e-3)


def test_walk_of_splines_is_found_again_within_its_optimum() -> None:
    """The acceleration at the cut is free in the new plan: it may be better than the rest of the old one, not worse."""
    walk = planned("gait=walk", "planner=zmp_spline", "duration_s=7")
    cut_s = 2.5
    rest = remaining_problem(
        walk.problem, planned_progress(walk.plan, cut_s), walk.robot, planned_state(walk, cut_s), SHORTEST_PHASE_S
    )
    again = walk.planner.solve(walk.planner.build(rest)).plan
    assert again is not None
    times = np.linspace(cut_s, walk.plan.duration_s, 4001)
    old = np.trapezoid([np.sum(walk.plan.com(t, 2) ** 2) for t in times], times)
    assert again.report.costs["com_acceleration"] < 1.01 * old
    for time in np.linspace(0.0, again.duration_s, 60):
        np.testing.assert_allclose(again.com(time)[:2], walk.plan.com(cut_s + time)[:2], atol=5e-3)


def test_waypoints_lie_where_the_plan_was_carried(trot: Planned) -> None:
    pose = np.array([0.3, -0.2, 0.1])
    progress = replace(planned_progress(trot.plan, 1.0), plan_pose_in_world=pose)
    state = replace(planned_state(trot, 1.0), angular_velocity_base_in_base=np.array([0.0, 0.0, 0.4]))
    rest = remaining_problem(trot.problem, progress, trot.robot, state, SHORTEST_PHASE_S)
    goal = trot.problem.waypoints.poses[-1]
    np.testing.assert_allclose(rest.waypoints.poses[-1, :2], pose[:2] + rotation_2d(0.1) @ goal[:2])
    assert rest.waypoints.poses[-1, 2] == pytest.approx(goal[2] + 0.1)
    np.testing.assert_allclose(rest.waypoints.poses[0], [*rest.start.com_position, rest.start.yaw])
    assert rest.waypoints.times_s[-1] == pytest.approx(rest.schedule.duration_s)
    assert rest.waypoints.yaw_rate == pytest.approx(0.4)


@pytest.mark.parametrize("turns", [-1, 0, 2])
def test_heading_is_counted_from_where_the_plan_has_turned_to(trot: Planned, turns: int) -> None:
    """The measured one does not know of whole turns; a plan that began over would turn them back."""
    poses = trot.problem.waypoints.poses + np.array([0.0, 0.0, 2.0 * np.pi * turns])
    problem = replace(trot.problem, waypoints=replace(trot.problem.waypoints, poses=poses))
    progress, state = planned_progress(trot.plan, 1.0), planned_state(trot, 1.0)
    rest = remaining_problem(problem, progress, trot.robot, state, SHORTEST_PHASE_S)
    assert rest.start.yaw == pytest.approx(2.0 * np.pi * turns, abs=0.05)
    assert np.ptp(rest.waypoints.poses[:, 2]) < 0.1


@pytest.mark.parametrize("before_s", [1e-4, 0.02, 0.049, 0.05, 0.2])
def test_heading_need_not_jump_to_a_waypoint_that_is_too_near(trot: Planned, before_s: float) -> None:
    """A robot that is 0.1 rad off its heading just before the end of a stride has the next stride to turn back."""
    stride_end_s = float(trot.problem.waypoints.times_s[2])
    cut_s = stride_end_s - before_s
    pushed = replace(planned_state(trot, cut_s), quat_wxyz=np.array([np.cos(0.05), 0.0, 0.0, np.sin(0.05)]))
    rest = remaining_problem(trot.problem, planned_progress(trot.plan, cut_s), trot.robot, pushed, SHORTEST_PHASE_S)
    times = rest.waypoints.times_s
    assert times[0] == 0.0
    assert (times[1] == pytest.approx(before_s)) == (before_s >= SHORTEST_PHASE_S)
    assert np.abs(np.diff(rest.waypoints.poses[:, 2]) / np.diff(times)).max() < 0.1 / SHORTEST_PHASE_S + 1e-6


@pytest.mark.parametrize("before_s", [1e-4, 0.02, 0.2])
def test_the_goal_stays_however_near_it_is(trot: Planned, before_s: float) -> None:
    cut_s = trot.plan.duration_s - before_s
    state, progress = planned_state(trot, cut_s), planned_progress(trot.plan, cut_s)
    rest = remaining_problem(trot.problem, progress, trot.robot, state, SHORTEST_PHASE_S)
    np.testing.assert_allclose(rest.waypoints.times_s, [0.0, before_s], atol=1e-9)
    np.testing.assert_allclose(rest.waypoints.poses[-1], trot.problem.waypoints.poses[-1])


def test_legs_that_stand_lose_the_rest_of_their_swing_only() -> None:
    flags = np.array([[0, 1, 1, 0], [1, 1, 1, 0], [0, 1, 1, 1]], dtype=bool)
    schedule = standing_on(ContactSchedule(np.array([0.1, 0.2, 0.3]), flags), np.array([True, True, True, False]))
    assert schedule.contacts.tolist() == [
        [True, True, True, False],
        [True, True, True, False],
        [False, True, True, True],
    ]


@dataclass
class FakeController:
    """Says where it is and remembers the plans it was given."""

    progresses: PlanProgress
    plans: list[MotionPlan] = field(default_factory=list)

    def progress(self, state: RobotState) -> PlanProgress:
        return replace(self.progresses, plan_time_s=state.time_s)

    def replace_plan(self, plan: MotionPlan, state: RobotState) -> None:
        self.plans.append(plan)


@dataclass
class FakePlanner:
    """Gives one answer, or refuses every problem."""

    answer: PlanningOutcome | None

    def prepare(self) -> None:
        pass

    def build(self, problem: PlanningProblem) -> PlanningProblem:
        if self.answer is None:
            raise PlanningProblemError("start.feet: holds NaN or infinity")
        return problem

    def solve(self, transcription: PlanningProblem) -> PlanningOutcome:
        assert self.answer is not None
        return self.answer


def run_replanner(
    motion: Planned, answer: PlanningOutcome | None, *, regular: bool = True, **config: Any
) -> tuple[Replanner, FakeController, list[tuple[float, str]]]:
    settings = ReplanningConfig.model_validate(
        {"period_s": 0.2, "shortest_phase_s": 0.05, "all_feet_down": False, **config}
    )
    replanner = Replanner(settings, motion.robot, FakePlanner(answer), motion.problem)
    controller: Any = FakeController(replace(planned_progress(motion.plan, 0.0), regular=regular))
    said = []
    for tick in range(round(4.0 / 0.0025)):
        state = replace(motion.robot.nominal_state(), time_s=tick * 0.0025)
        if (text := replanner.update(controller, state)) is not None:
            said.append((state.time_s, text))
    return replanner, controller, said


def test_plans_are_made_every_period_but_not_just_before_a_switch(trot: Planned) -> None:
    answer = PlanningOutcome(PlanningStatus.SOLVED, "", trot.plan)
    replanner, controller, said = run_replanner(trot, answer)
    times = [time for time, _ in said]
    assert len(controller.plans) == len(times) == replanner.attempts
    assert times[0] == pytest.approx(0.2)
    assert np.diff(times).min() > 0.2 - 1e-6
    assert np.diff(times).max() < 0.2 + 0.05 + 0.01
    switches = trot.plan.schedule.switch_times_s
    for time in times:
        assert (switches[switches > time + 1e-6] - time).min() >= 0.05 - 1e-6
    assert times[-1] < max(swings[-1].end_s for swings in trot.plan.schedule.swings)
    assert replanner.summary()["replanning_failures"] == 0


@pytest.mark.parametrize("refused", [False, True], ids=["infeasible", "malformed"])
def test_failure_keeps_the_old_plan_and_is_counted(trot: Planned, refused: bool) -> None:
    answer = None if refused else PlanningOutcome(PlanningStatus.INFEASIBLE, "range_of_motion", None)
    replanner, controller, said = run_replanner(trot, answer)
    assert controller.plans == []
    assert replanner.failures == replanner.attempts == len(said) > 5
    assert all("the old plan holds" in text for _, text in said)
    assert ("NaN" if refused else "range_of_motion") in said[0][1]
    assert replanner.summary()["replanning_median_ms"] is None


def test_never_means_never_and_irregular_legs_mean_later(trot: Planned) -> None:
    answer = PlanningOutcome(PlanningStatus.SOLVED, "", trot.plan)
    never, _, said = run_replanner(trot, answer, period_s=None)
    assert said == []
    assert never.summary() == {}
    assert run_replanner(trot, answer, regular=False)[2] == []


def run(directory: Path, *overrides: str) -> TrialResult:
    directory.mkdir()
    return run_trial(compose_trial(overrides), directory, SilentProgress())


def test_trot_that_is_pushed_and_plans_again_stays_up_and_is_repeatable(tmp_path: Path) -> None:
    pushed = ["scenario=push", "scenario.pushes.0.force_n=100", "scenario.pushes.0.start_s=1.0", "duration_s=2.6"]
    results = [run(tmp_path / name, *pushed, "replanning.period_s=0.2") for name in "ab"]
    assert results[0].status is TrialStatus.COMPLETED, results[0].status_reason
    assert results[0].replannings is not None and results[0].replannings > 5
    assert results[0].replanning_failures is not None and results[0].replanning_failures < results[0].replannings
    assert results[0].state_sha256 == results[1].state_sha256


def test_undisturbed_turning_trot_that_plans_again_turns_as_far(tmp_path: Path) -> None:
    turning = ["command=turn", "duration_s=3.0"]
    once, often = run(tmp_path / "once", *turning), run(tmp_path / "often", *turning, "replanning.period_s=0.2")
    assert often.status is TrialStatus.COMPLETED, often.status_reason
    assert once.distance_m is not None and often.distance_m is not None
    assert often.distance_m == pytest.approx(once.distance_m, abs=0.05)
    assert often.replanning_failures == 0
    assert once.replannings is None


def test_planning_waits_for_all_feet_if_told_to(trot: Planned) -> None:
    answer = PlanningOutcome(PlanningStatus.SOLVED, "", trot.plan)
    settings = ReplanningConfig(period_s=0.2, shortest_phase_s=0.0, all_feet_down=True)
    replanner = Replanner(settings, trot.robot, FakePlanner(answer), trot.problem)
    for time in np.arange(0.0, 4.0, 0.0025):
        controller: Any = FakeController(planned_progress(trot.plan, time))
        if replanner.update(controller, replace(trot.robot.nominal_state(), time_s=float(time))) is not None:
            assert trot.plan.schedule.contacts_at(time).all()
    assert replanner.attempts > 3


@pytest.mark.parametrize(
    "overrides",
    [
        ["planner=zmp_spline", "gait=walk", "duration_s=7", "replanning.period_s=1.5"],
        ["planner=kinematic_sqp", "duration_s=2.5", "replanning.period_s=0.4", "replanning.all_feet_down=true"],
        ["estimator=ekf", "duration_s=2.5", "replanning.period_s=0.3"],
    ],
    ids=["zmp_spline", "kinematic_sqp", "ekf"],
)
def test_every_planner_can_be_asked_again_on_the_way(overrides: list[str], tmp_path: Path) -> None:
    result = run(tmp_path / "trial", *overrides)
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    assert result.replannings is not None and result.replannings > 1
    assert result.replanning_failures == 0
    assert result.com_error_max_mm is not None and result.com_error_max_mm < 15.0
