"""Every motion of the paper comes out of its contact schedule alone."""

from typing import Any

import numpy as np
import pytest
from planning_cases import MODELS, gait, plan, planner, standing

from quadlab.errors import PlanningProblemError
from quadlab.gaits.gait import contact_schedule, stride_times
from quadlab.geometry.rotations import Array
from quadlab.planners.command import GoalCommand, waypoints
from quadlab.planners.plan import MotionPlan
from quadlab.planners.plan_io import bytes_to_plan, plan_to_bytes
from quadlab.planners.planner import PlanningOutcome, PlanningStatus
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.vertex_zmp.biped import LINE_FOOT, RECTANGULAR_FOOT, biped_problem
from quadlab.planners.vertex_zmp.fast.build import build_fast
from quadlab.planners.vertex_zmp.fast.solve import solve
from quadlab.planners.vertex_zmp.random_problems import random_problem
from quadlab.planners.vertex_zmp.table_one import (
    TABLE_ONE,
    TableOneCase,
    schedule_of,
    straight_problem,
    table_one_changes,
    table_one_phases,
    table_one_problem,
)

FREE: dict[str, Any] = dict.fromkeys(
    ("robustness_weight", "com_acceleration_weight", "nominal_foothold_weight", "waypoint_weight"), 0.0
)
MOTIONS = {  # gait: (duration in [s], distance in [m])
    "pace": (4.0, 0.6),
    "bound": (4.0, 0.6),
    "limp": (8.0, 0.3),
    "three_legs": (4.8, 0.3),
    "walk_to_trot": (9.0, 0.6),
    "trot_bound_pace_walk": (10.0, 0.9),
}
ROBUST = pytest.mark.parametrize("costs", [{}, FREE], ids=["with costs", "without costs"])


def solved(outcome: PlanningOutcome) -> MotionPlan:
    assert outcome.plan is not None, outcome.reason
    return outcome.plan


def motion_problem(robot: str, gait_name: str) -> PlanningProblem:
    duration, distance = MOTIONS[gait_name]
    command = GoalCommand(kind="goal", x_m=distance, y_m=0.0, yaw_deg=0.0)
    path = waypoints(command, stride_times(gait(gait_name), duration), np.zeros(3), duration)
    return PlanningProblem(standing(MODELS[robot]), path, contact_schedule(gait(gait_name), duration), MODELS[robot])


@pytest.mark.parametrize("case", TABLE_ONE, ids=lambda case: case.name)
def test_table_one_keeps_cop_and_feet_where_they_belong(case: TableOneCase) -> None:
    motion = solved(plan(table_one_problem(case), **table_one_changes(case, "fast")))
    assert motion.verdict.values["cop_outside_mm"] < 0.1
    assert motion.verdict.values["reach_outside_mm"] < 1.0
    assert sum(len(footholds) - 1 for footholds in motion.footholds) == case.steps
    assert motion.duration_s == pytest.approx({16: 4.0, 4: 1.0}[case.steps] * case_stride_s(case))


def case_stride_s(case: TableOneCase) -> float:
    return sum(duration for duration, _ in table_one_phases(case.gait))


@pytest.mark.parametrize("case", TABLE_ONE, ids=lambda case: case.name)
def test_table_one_converges_from_standing_in_the_default_stance(case: TableOneCase) -> None:
    config = planner(**table_one_changes(case, "fast")).config
    build = build_fast(table_one_problem(case), config)
    model = build.transcription.model
    still = build.transcription.vector(build.transcription.guess)
    still[model.columns.states[1:-1]] = 0.0
    stance_feet = np.concatenate([[leg] * (len(s) + 1) for leg, s in enumerate(model.problem.schedule.swings)])
    still[model.columns.stances] = model.problem.start.feet[stance_feet, :2]
    solution = solve(build.prepared, still[build.transcription.unknowns.index >= 0], config)
    assert solution.converged, solution.status
    assert max(solution.residuals.values()) < 1e-6


@ROBUST
@pytest.mark.parametrize("gait_name", MOTIONS)
@pytest.mark.parametrize("robot", MODELS)
def test_gaits_and_their_transitions(robot: str, gait_name: str, costs: dict[str, Any]) -> None:
    motion = solved(plan(motion_problem(robot, gait_name), **costs))
    assert motion.verdict.values["cop_outside_mm"] < 0.1
    assert motion.com(motion.duration_s)[0] == pytest.approx(MOTIONS[gait_name][1], abs=1e-6)


@pytest.mark.parametrize(("first", "back_m"), [("LH", 0.2), ("RH", 0.2), ("LF", 0.0), ("RF", 0.0)])
def test_even_loads_push_a_walk_back_that_begins_with_a_hind_leg(first: str, back_m: float) -> None:
    """What the verdict on the walk of Winkler 2017, Fig. 5, says: three feet carry alike, so the CoP is off the CoM."""
    phases = table_one_phases("walk")
    begin = [leg for _, leg in phases].index(first)
    problem = straight_problem(schedule_of((phases[begin:] + phases[:begin]) * 4), np.array([1.0, 0.0]))
    walk = solved(plan(problem, **table_one_changes(TABLE_ONE[0], "fast")))
    farthest = min(float(walk.com(time)[0]) for time in np.arange(0.0, walk.duration_s, 0.05))
    assert -farthest == pytest.approx(back_m, abs=0.03)


def test_lame_leg_carries_nothing() -> None:
    problem = motion_problem("anymal", "three_legs")
    lame = problem.schedule.contacts[1:-1, 0]
    assert not lame.any()
    assert solved(plan(problem)).verdict.accepted


@pytest.mark.parametrize("transcription", ["fast", "paper"])
@pytest.mark.parametrize(
    ("velocity", "status"),
    [
        ([0.8, 0.0], PlanningStatus.SOLVED),
        ([0.0, 0.8], PlanningStatus.SOLVED),
        ([0.0, 1.2], PlanningStatus.INFEASIBLE),
    ],
    ids=["forward", "sideways", "too much"],
)
def test_push_recovery(velocity: list[float], status: PlanningStatus, transcription: str) -> None:
    push = np.array(velocity)
    schedule = schedule_of(((0.1, ""), *table_one_phases("trot") * 4))
    outcome = plan(straight_problem(schedule, 0.5 * push, velocity=push), transcription=transcription)
    assert outcome.status is status, outcome.reason
    if status is PlanningStatus.INFEASIBLE:
        assert "constraint sets violated" in outcome.reason


@pytest.mark.parametrize("vertices", [RECTANGULAR_FOOT, LINE_FOOT], ids=["square", "line"])
@pytest.mark.parametrize("goal", [[0.4, 0.0, 0.0], [0.3, 0.1, 0.6]], ids=["straight", "turning"])
def test_biped_with_feet_that_have_length(vertices: Array, goal: list[float]) -> None:
    motion = solved(plan(biped_problem(vertices, 4, np.array(goal)), transcription="paper"))
    assert motion.verdict.values["cop_outside_mm"] < 0.1
    assert motion.foot_yaws[0][-1] == pytest.approx(goal[2], abs=0.1)
    again = bytes_to_plan(plan_to_bytes(motion))
    np.testing.assert_array_equal(again.foot_yaws[1], motion.foot_yaws[1])


def test_cop_of_a_biped_leaves_the_points_of_its_feet() -> None:
    """With one point foot in contact the CoP is that point; a square gives it room."""
    square = solved(plan(biped_problem(RECTANGULAR_FOOT, 2, np.zeros(3)), transcription="paper"))
    point = solved(plan(biped_problem(np.zeros((1, 2)), 2, np.zeros(3))))
    times = np.linspace(0.25, 0.55, 20)  # single support on the right foot
    assert np.ptp([square.cop(t)[1] for t in times]) > 0.003
    assert np.ptp([point.cop(t)[1] for t in times]) < 1e-9


def test_feet_with_length_are_refused_by_the_reduced_program_in_one_line() -> None:
    with pytest.raises(PlanningProblemError, match="'fast' knows point feet, the model has feet with 4 vertices"):
        planner(transcription="fast").build(biped_problem(RECTANGULAR_FOOT, 2, np.zeros(3)))


@pytest.mark.parametrize("seed", range(40))
def test_random_problems_are_solved_or_infeasible_for_both_programs(seed: int) -> None:
    case = random_problem(seed)
    outcome = plan(case.problem, **case.changes)
    if outcome.status is not PlanningStatus.SOLVED:
        assert outcome.status is PlanningStatus.INFEASIBLE, outcome.reason
        assert plan(case.problem, **case.changes, transcription="paper").status is PlanningStatus.INFEASIBLE
