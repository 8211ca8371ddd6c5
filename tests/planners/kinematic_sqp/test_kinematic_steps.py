"""Quadratic programs: every solver finds the same answer, wrong answers are noticed, rare rows join."""

import numpy as np
import pytest
from kinematic_cases import PAPER_MOTIONS, planner, problem
from scipy.sparse import csc_array

from quadlab.planners.kinematic_sqp.qp.problem import QpAnswer, QuadraticProgram, residual
from quadlab.planners.kinematic_sqp.qp.solvers import QP_SOLVERS
from quadlab.planners.kinematic_sqp.sqp import minimise


def small_program() -> QuadraticProgram:
    """A random convex program of 8 variables with 12 rows, some of them active."""
    random = np.random.default_rng(0)
    root = random.standard_normal((8, 8))
    rows = random.standard_normal((12, 8))
    gradient = 5.0 * random.standard_normal(8)
    return QuadraticProgram(
        csc_array(root @ root.T + np.eye(8)), gradient, csc_array(rows), np.full(12, -0.3), np.full(12, 0.2)
    )


@pytest.mark.parametrize("name", QP_SOLVERS)
def test_solver_meets_the_optimality_conditions(name: str) -> None:
    program = small_program()
    answer = QP_SOLVERS[name]().solve(program, 1e-9)
    assert residual(program, answer) < 1e-7
    assert (np.abs(answer.multipliers) > 1e-3).any()  # the test would say little without active rows


def test_wrong_answers_are_noticed() -> None:
    program = small_program()
    answer = QP_SOLVERS["proxqp"]().solve(program, 1e-9)
    assert residual(program, QpAnswer(answer.step + 1e-2, answer.multipliers)) > 1e-3
    assert residual(program, QpAnswer(answer.step, -answer.multipliers)) > 1e-3
    assert residual(program, QpAnswer(answer.step * np.nan, answer.multipliers)) == np.inf


def test_slow_joints_stay_within_their_limit() -> None:
    """Speed rows are not in the first quadratic program; they join when a step violates them."""
    asked = problem("anymal_b", PAPER_MOTIONS["trot"])
    free, slow = planner(), planner(joint_speed_radps=1.2)
    fastest = []
    for kinematic in (free, slow):
        build = kinematic.build(asked)
        minimum = minimise(build.program, kinematic.config.sqp)
        assert minimum.converged, minimum.reason
        joints = build.program.layout.value("joints", minimum.p)
        fastest.append(float(np.abs(np.diff(joints, axis=0) / build.program.grid.periods_s[:, None]).max()))
    assert fastest[0] > 1.5
    assert fastest[1] == pytest.approx(1.2, abs=1e-3)
