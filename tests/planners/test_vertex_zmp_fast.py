"""The reduced program is the same problem as the paper's formulation, and its solver solves it."""

from dataclasses import replace

import numpy as np
import pytest
from planning_cases import COMMANDS, plan, planner, problem, solved, standing
from scipy import sparse
from scipy.integrate import solve_ivp

from quadlab.errors import PlanningProblemError
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.polygons import distances_outside
from quadlab.planners.checker import check_plan
from quadlab.planners.planner import PlanningStatus
from quadlab.planners.problem import Waypoints
from quadlab.planners.vertex_zmp.fast.build import FastBuild, build_fast
from quadlab.planners.vertex_zmp.fast.solve import prepare
from quadlab.planners.vertex_zmp.fast.solver.kkt import forget_plans, kkt_plan
from quadlab.planners.vertex_zmp.fast.tension_spline import TensionSpline
from quadlab.planners.vertex_zmp.fast.transcription import transcribe
from quadlab.planners.vertex_zmp.table_one import TABLE_ONE, table_one_changes, table_one_problem

CASES = [("anymal", "trot", "turn"), ("anymal", "walk", "forward"), ("hyq", "walk", "turn")]
case = pytest.mark.parametrize(("robot", "gait_name", "command"), CASES, ids=["-".join(names) for names in CASES])


def build(robot: str, gait_name: str, command: str) -> FastBuild:
    return build_fast(problem(robot, gait_name, COMMANDS[command]), planner().config)


@case
def test_plan_is_that_of_the_paper_formulation(robot: str, gait_name: str, command: str) -> None:
    """Tolerances: what a quartic with three collocation points every 0.1 s differs from the exact pendulum."""
    fast = solved(robot, gait_name, command).plan
    paper = plan(problem(robot, gait_name, COMMANDS[command]), transcription="paper").plan
    assert fast is not None
    assert paper is not None
    for time in np.linspace(0.0, fast.duration_s, 100):
        np.testing.assert_allclose(fast.com(time), paper.com(time), atol=1e-3)
    for footholds, expected in zip(fast.footholds, paper.footholds, strict=True):
        np.testing.assert_allclose(footholds, expected, atol=3e-3)
    for name, value in paper.report.costs.items():
        assert fast.report.costs[name] == pytest.approx(value, rel=0.02, abs=2e-5)


@pytest.mark.parametrize("transcription", ["fast", "paper"])
def test_costs_of_every_iteration_are_reported_by_name(transcription: str) -> None:
    result = plan(problem("anymal", "trot", COMMANDS["forward"]), transcription=transcription).plan
    assert result is not None
    history = result.report.cost_history
    assert len(history) == result.report.iterations + 1
    assert history[-1] == pytest.approx(result.report.costs)
    assert all(costs.keys() == result.report.costs.keys() for costs in history)


@pytest.mark.parametrize("steps", [16, 4])
def test_cost_of_the_walks_of_table_one_is_that_of_the_paper_formulation(steps: int) -> None:
    walk = next(entry for entry in TABLE_ONE if entry.gait == "walk" and entry.steps == steps)
    costs = []
    for transcription in ("fast", "paper"):
        motion = plan(table_one_problem(walk), **table_one_changes(walk, transcription)).plan
        assert motion is not None
        costs.append(motion.report.costs["robustness"])
    assert costs[0] == pytest.approx(costs[1], rel=0.01)


@case
def test_jacobian_and_gradient_agree_with_finite_differences(robot: str, gait_name: str, command: str) -> None:
    made = build(robot, gait_name, command)
    program, random = made.transcription.program, np.random.default_rng(0)
    z = made.transcription.guess + 0.01 * random.standard_normal(program.size)
    for direction in random.standard_normal((5, program.size)):
        ahead, behind = z + 1e-5 * direction, z - 1e-5 * direction
        change = (program.equality_values(ahead) - program.equality_values(behind)) / 2e-5
        np.testing.assert_allclose(change, program.jacobian(z) @ direction, atol=1e-7)
        slope = (program.objective(ahead) - program.objective(behind)) / 2e-5
        gradient = program.hessian @ z + program.gradient
        assert slope == pytest.approx(float(gradient @ direction), rel=1e-6, abs=1e-6)
        np.testing.assert_allclose(sum(program.costs(z).values()), program.objective(z), rtol=1e-9)


@pytest.mark.parametrize("duration_s", [0.01, 0.1, 0.5])
def test_tension_spline_is_the_pendulum_under_a_linear_cop(duration_s: float) -> None:
    spline = TensionSpline(np.array([duration_s]), 4.0)
    first, random = np.array([0]), np.random.default_rng(1)
    ends = random.standard_normal(4) * [0.1, 0.3, 0.1, 0.3]
    u_start, u_end = (float(spline.cop_weights(first, np.array([s]))[0] @ ends) for s in (0.0, 1.0))

    def fall(time: float, state: np.ndarray) -> list[float]:
        return [state[1], 16.0 * (state[0] - u_start - (u_end - u_start) * time / duration_s)]

    shares = [0.25, 0.5, 1.0]
    times = duration_s * np.array(shares)
    motion = solve_ivp(fall, (0.0, duration_s), ends[:2], rtol=1e-10, atol=1e-12, t_eval=times).y
    for number, share in enumerate(shares):
        at = np.array([share])
        found = [float(spline.weights(first, at, derivative)[0] @ ends) for derivative in (0, 1)]
        np.testing.assert_allclose(found, motion[:, number], atol=1e-6 * max(1.0, abs(u_end)))


@case
def test_motion_has_no_defect_and_the_cop_stays_in_the_hull(robot: str, gait_name: str, command: str) -> None:
    motion = solved(robot, gait_name, command).plan
    assert motion is not None
    assert motion.verdict.values["dynamics_defect_m_s2"] < 1e-6
    for time in np.linspace(1e-4, motion.duration_s - 1e-4, 500):
        stands = np.flatnonzero(motion.schedule.contacts_at(time)).tolist()
        corners = np.array([motion.foothold_at(leg, time)[:2] for leg in stands])
        assert distances_outside(motion.cop(time)[None], corners)[0] < 1e-7


@case
def test_plan_of_the_factorisation_holds_every_entry(robot: str, gait_name: str, command: str) -> None:
    """The symbolic factor covers the numeric one of a dense Cholesky factorisation."""
    program = build(robot, gait_name, command).transcription.program
    plan_ = kkt_plan(program)
    size = program.size + len(program.right)
    order, random = plan_.elimination.order, np.random.default_rng(2)
    values = random.uniform(0.1, 1.0, len(plan_.elimination.k_rows))
    columns = np.repeat(np.arange(size), np.diff(plan_.elimination.k_begins))
    upper = sparse.csc_array((values, (plan_.elimination.k_rows, columns)), shape=(size, size)).toarray()
    dominant = upper + upper.T + 2.0 * size * np.eye(size)
    factor = np.linalg.cholesky(dominant)
    pattern = np.zeros((size, size), dtype=bool)
    pattern[plan_.elimination.l_rows, np.repeat(np.arange(size), np.diff(plan_.elimination.l_begins))] = True
    assert not (np.abs(np.tril(factor, -1)) > 1e-13)[~pattern].any()
    assert sorted(order) == list(range(size))


def test_plans_of_factorisations_are_remembered_by_pattern() -> None:
    forget_plans()
    trot = problem("anymal", "trot", COMMANDS["forward"])
    program = transcribe(trot, planner().config).program
    moved = replace(trot, start=standing(trot.model, np.array([0.05, 0.02])))
    assert kkt_plan(program) is kkt_plan(transcribe(moved, planner().config).program)


def test_repeated_solves_give_the_same_answer() -> None:
    made = build("anymal", "trot", "forward")
    np.testing.assert_array_equal(made.solve().x, made.solve().x)
    assert prepare(made.transcription.program).plan is made.prepared.plan


@pytest.mark.parametrize("stance_s", [1e-3, 0.02, 3.0])
def test_phases_of_any_length(stance_s: float) -> None:
    contacts = np.array([[True] * 4, [True, False, False, True], [True] * 4])
    schedule = ContactSchedule(np.array([0.3, 0.3, stance_s]), contacts)
    trot = problem("anymal", "trot", COMMANDS["in_place"])
    outcome = plan(replace(trot, schedule=schedule, waypoints=two_poses(schedule.duration_s, 0.0)))
    assert outcome.status is PlanningStatus.SOLVED, outcome.reason


def two_poses(duration_s: float, distance: float) -> Waypoints:
    path = np.array([[0.0, 0.0, 0.0], [distance, 0.0, 0.0]])
    return Waypoints(np.array([0.0, duration_s]), path)


@pytest.mark.parametrize("transcription", ["fast", "paper"])
def test_a_hundred_metres_in_a_second_are_an_answer(transcription: str) -> None:
    trot = problem("anymal", "trot", COMMANDS["forward"])
    schedule = ContactSchedule(np.array([0.3, 0.4, 0.3]), trot.schedule.contacts[:3])
    far = replace(trot, schedule=schedule, waypoints=two_poses(1.0, 100.0))
    outcome = plan(far, transcription=transcription)
    assert outcome.status is PlanningStatus.INFEASIBLE
    assert "100 m away" in outcome.reason


@pytest.mark.parametrize("transcription", ["fast", "paper"])
def test_crossed_feet_are_an_answer_that_names_the_box(transcription: str) -> None:
    trot = problem("anymal", "trot", COMMANDS["forward"])
    crossed = replace(trot.start, feet=trot.start.feet[[1, 0, 3, 2]])
    outcome = plan(replace(trot, start=crossed), transcription=transcription)
    assert outcome.status is PlanningStatus.INFEASIBLE
    assert "range_of_motion_m" in outcome.reason


def test_a_pendulum_that_falls_within_an_interval_is_refused_in_one_line() -> None:
    trot = problem("anymal", "trot", COMMANDS["forward"])
    with pytest.raises(PlanningProblemError, match=r"model\.com_height: at 1e-06 m"):
        planner().build(replace(trot, model=replace(trot.model, com_height=1e-6)))


def test_not_a_number_in_the_iterate_is_no_solution() -> None:
    program = build("anymal", "trot", "forward").transcription.program
    assert all(np.isnan(value) for value in program.residuals(np.full(program.size, np.nan)).values())


def test_costs_do_not_make_a_feasible_problem_infeasible() -> None:
    walk = problem("hyq", "walk", COMMANDS["forward"])
    outcome = plan(walk, nominal_foothold_weight=1e4, com_acceleration_weight=10.0)
    assert outcome.status is PlanningStatus.SOLVED, outcome.reason


def test_what_the_planner_returns_passes_the_checker_again() -> None:
    motion = solved("hyq", "walk", "turn").plan
    assert motion is not None
    again = check_plan(motion, problem("hyq", "walk", COMMANDS["turn"]), planner().config.checker)
    assert again.values == motion.verdict.values
