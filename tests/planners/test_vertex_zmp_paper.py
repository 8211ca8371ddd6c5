"""What holds for the paper's formulation: CasADi, Ipopt, feet of any shape."""

import casadi as ca
import numpy as np
from planning_cases import COMMANDS, plan, planner, problem

from quadlab.planners.planner import PlanningStatus
from quadlab.planners.vertex_zmp.paper.build import PaperBuild


def test_iteration_limit_is_an_outcome_in_words_of_ipopt() -> None:
    outcome = plan(problem("anymal", "walk", COMMANDS["forward"]), max_iterations=2, transcription="paper")
    assert outcome.status is PlanningStatus.SOLVER_LIMIT
    assert "Maximum_Iterations_Exceeded" in outcome.reason
    assert "lip_dynamics_m" in outcome.reason or "range_of_motion_m" in outcome.reason
    assert "clock" not in outcome.reason


def test_reason_says_that_the_clock_ended_it() -> None:
    outcome = plan(problem("anymal", "walk", COMMANDS["forward"]), max_wall_time_s=1e-6, transcription="paper")
    assert outcome.status is PlanningStatus.SOLVER_LIMIT
    assert "the clock ended it, max_wall_time_s" in outcome.reason


def test_shorter_polynomials_follow_the_pendulum_better() -> None:
    trot = problem("anymal", "trot", COMMANDS["forward"])
    defects = []
    for duration in (0.2, 0.1, 0.05):
        motion = plan(trot, polynomial_duration_s=duration, transcription="paper").plan
        assert motion is not None
        defects.append(motion.verdict.values["dynamics_defect_m_s2"])
    assert defects[0] > 3.0 * defects[1] > 9.0 * defects[2]


def test_derivatives_of_the_program_agree_with_finite_differences() -> None:
    trot = problem("anymal", "trot", COMMANDS["turn"])
    build = planner(polynomial_duration_s=0.4, transcription="paper").build(trot)
    assert isinstance(build, PaperBuild)
    program = build.transcription
    multipliers = ca.SX.sym("multipliers", program.g.numel())
    lagrangian = program.f + ca.dot(multipliers, program.g)
    hessian, gradient = ca.hessian(lagrangian, program.x)
    inputs = [program.x, program.p, multipliers]
    values = ca.Function("values", inputs, [program.g, gradient])
    derivatives = ca.Function("derivatives", inputs, [ca.jacobian(program.g, program.x), hessian])
    random = np.random.default_rng(0)
    x = program.guess + 0.01 * random.standard_normal(len(program.guess))
    given = program.parameters, random.standard_normal(program.g.numel())
    jacobian, curvature = (np.array(matrix) for matrix in derivatives(x, *given))
    for direction in random.standard_normal((5, len(x))):
        ahead, behind = values(x + 1e-4 * direction, *given), values(x - 1e-4 * direction, *given)
        change = [(np.array(a) - np.array(b)).ravel() / 2e-4 for a, b in zip(ahead, behind, strict=True)]
        np.testing.assert_allclose(change[0], jacobian @ direction, rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(change[1], curvature @ direction, rtol=1e-6, atol=1e-5)
