"""The quadratic program is the one that was meant, and solvers find its minimum."""

import numpy as np
import pytest
import qpsolvers
from planning_cases import MODELS
from zmp_spline_cases import spline_planner, walk

from quadlab.errors import MissingDependencyError
from quadlab.geometry.rotations import Array
from quadlab.planners.zmp_spline.costs.com_acceleration import com_acceleration
from quadlab.planners.zmp_spline.program import QuadraticProgram
from quadlab.planners.zmp_spline.qp import optimality_residual, solve_program
from quadlab.planners.zmp_spline.support import support_polygon
from quadlab.planners.zmp_spline.transcription import zmp_polynomials

SOLVERS = ["piqp", "clarabel", "daqp"]
SHORT = 7.0  # [s] one stride


def program(**changes: object) -> QuadraticProgram:
    built = spline_planner(**changes).build(walk(duration_s=SHORT)).program
    assert built is not None
    return built


def objective(asked: QuadraticProgram, solution: Array) -> float:
    return float(0.5 * solution @ (asked.hessian @ solution) + asked.gradient @ solution)


@pytest.mark.parametrize("terms", [{}, {"support_centre_weight": 0.3, "waypoint_weight": 0.7}], ids=["paper", "all"])
def test_program_is_the_sum_of_its_named_costs(terms: dict[str, float]) -> None:
    asked, generator = program(**terms), np.random.default_rng(0)
    one, other = generator.normal(size=(2, len(asked.gradient)))
    total = [sum(asked.cost_values(asked.states(z)).values()) for z in (one, other)]
    assert objective(asked, one) - objective(asked, other) == pytest.approx(total[0] - total[1], rel=1e-9)
    assert len(asked.costs) == 1 + len(terms)


def test_gradient_matches_finite_differences_of_the_costs() -> None:
    asked = program(support_centre_weight=0.3)
    point = np.random.default_rng(1).normal(size=len(asked.gradient))
    gradient = asked.hessian @ point + asked.gradient
    for column in range(0, len(point), 7):
        step = np.zeros(len(point))
        step[column] = 1e-3
        costs = [sum(asked.cost_values(asked.states(point + sign * step)).values()) for sign in (1, -1)]
        assert (costs[0] - costs[1]) / 2e-3 == pytest.approx(gradient[column], rel=1e-6, abs=1e-6)


def test_acceleration_cost_is_the_integral() -> None:
    model = spline_planner().build(walk(duration_s=SHORT)).model
    states = np.random.default_rng(2).normal(size=model.grid.size)
    coefficients = model.grid.coefficients(states)
    total = 0.0
    for polynomial, duration in zip(coefficients, model.grid.durations_s, strict=True):
        for axis in range(2):
            acceleration = np.polynomial.Polynomial(polynomial[:, axis]).deriv(2)
            total += float((acceleration**2).integ()(duration))
    assert com_acceleration(model).value(states) == pytest.approx(total, rel=1e-9)


@pytest.mark.parametrize("solver", SOLVERS)
def test_answer_is_feasible_and_no_feasible_neighbour_is_better(solver: str) -> None:
    asked = program()
    answer = solve_program(asked, solver, 1e-9)
    best = objective(asked, answer.solution)
    assert answer.residual < 1e-6
    assert (asked.rows @ answer.solution - asked.upper).max() < 1e-7
    generator = np.random.default_rng(3)
    inside = solve_program(program(support_margin_m=0.06), solver, 1e-9).solution  # feasible with room to spare
    for _ in range(20):
        share = generator.uniform(0.0, 1.0)
        neighbour = (1.0 - share) * answer.solution + share * inside
        assert (asked.rows @ neighbour - asked.upper).max() < 1e-7
        assert objective(asked, neighbour) >= best - 1e-9


def test_all_solvers_agree() -> None:
    answers = [solve_program(program(), solver, 1e-9).solution for solver in SOLVERS]
    for answer in answers[1:]:
        np.testing.assert_allclose(answer, answers[0], atol=1e-4)


def test_wrong_answers_are_noticed() -> None:
    asked = program()
    answer = solve_program(asked, "piqp", 1e-9)
    assert optimality_residual(asked, answer.solution, np.zeros(len(asked.upper))) > 1e-3
    assert optimality_residual(asked, np.full(len(asked.gradient), np.nan), np.zeros(len(asked.upper))) == np.inf


@pytest.mark.parametrize("solver", SOLVERS)
def test_contradiction_is_no_answer(solver: str) -> None:
    asked = program(reach_margin_m=0.09)  # [m] a lateral box of 1 cm, while the CoM has to sway
    answer = solve_program(asked, solver, 1e-9)
    violation = (asked.rows @ answer.solution - asked.upper).max()
    assert not (answer.residual < 1e-5 and violation < 1e-6)


def test_zmp_polynomial_is_the_com_minus_its_scaled_acceleration() -> None:
    com, rate_squared = np.random.default_rng(4).normal(size=(3, 6, 2)), 20.0
    zmp = zmp_polynomials(com, rate_squared)
    for piece in range(3):
        for axis in range(2):
            curve = np.polynomial.Polynomial(com[piece, :, axis])
            at = np.linspace(0.0, 0.5, 7)
            expected = curve(at) - curve.deriv(2)(at) / rate_squared
            np.testing.assert_allclose(np.polynomial.Polynomial(zmp[piece, :, axis])(at), expected, atol=1e-12)


@pytest.mark.parametrize("legs", [[0, 1, 2, 3], [0, 1, 2], [1, 2, 3]])
@pytest.mark.parametrize("margin", [0.0, 0.03, 0.05])
def test_corners_of_a_shrunk_support_lie_on_two_edges_and_inside_all(legs: list[int], margin: float) -> None:
    polygon = support_polygon(MODELS["anymal"].nominal_feet[legs], margin)
    slack = polygon.offsets - polygon.corners @ polygon.normals.T
    assert len(polygon.corners) == len(legs)
    assert slack.min() > -1e-9
    assert ((slack < 1e-9).sum(axis=1) == 2).all()


def test_support_is_empty_inside_a_margin_beyond_its_inner_circle() -> None:
    triangle = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]])  # inner circle of radius 1
    assert not support_polygon(triangle, 0.99).is_empty
    assert support_polygon(triangle, 1.01).is_empty
    assert support_polygon(triangle[:2], 0.001).is_empty
    assert not support_polygon(triangle[:2], 0.0).is_empty
    assert support_polygon(triangle[:1], 0.001).is_empty


def test_missing_solver_names_those_that_are_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(qpsolvers, "available_solvers", ["piqp"])
    with pytest.raises(MissingDependencyError, match=r"'clarabel' is not installed; installed: piqp"):
        solve_program(program(), "clarabel", 1e-9)
