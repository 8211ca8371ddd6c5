"""The cascade as printed: the same hierarchies, the same answers, and no failure that goes unnoticed."""

import itertools
from typing import get_args

import numpy as np
import pytest
import qpsolvers

from quadlab.controllers.hierarchy import HierarchyError, Level, certificate, solve_hierarchy
from quadlab.controllers.hierarchy.cascade import CascadeSolution, CascadeStatus, QpSolver, solve_cascade
from quadlab.controllers.hierarchy.daqp_hierarchical import solve_daqp_hierarchical
from quadlab.controllers.hierarchy.random_hierarchy import DIMENSION, random_hierarchy
from quadlab.geometry.rotations import Array

OPEN = np.inf
SOLVERS: tuple[QpSolver, ...] = get_args(QpSolver)
ACCURATE: tuple[QpSolver, ...] = ("clarabel", "daqp", "piqp")
solvers = pytest.mark.parametrize("qp_solver", SOLVERS)


def equality(name: str, matrix: Array, target: Array) -> Level:
    return Level(name, matrix, target, target)


def conflicting_third() -> list[Level]:
    """Inequalities on levels 1 and 2 that both bind, and a third level that pulls against both of them.

    x <= 1 and y <= 4 come first; x >= 2 and y >= 5 can then only come as close as the corner (1, 4); the third level
    must not undo either. A stack with the rows in one order and the slacks in the other would trade them.
    """
    return [
        Level("first", np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), np.array([-OPEN, -OPEN]), np.array([1.0, 4.0])),
        Level("second", np.array([[1.0, 0.0, 0.0], [0.0, 0.5, 0.0]]), np.array([3.0, 2.5]), np.array([OPEN, OPEN])),
        equality("third", np.eye(3), np.array([-5.0, 9.0, 7.0])),
    ]


def first_difference(levels: list[Level], x: Array) -> float:
    """How much worse ``x`` is than the lexicographic solution at the first level where they differ, relative."""
    best = solve_hierarchy(levels)
    for level in levels:
        norm = best.residual_norms[level.name]
        difference = float(np.linalg.norm(level.violation(x))) - norm
        if abs(difference) > 1e-3 * (1.0 + norm):
            return difference
    return 0.0


@solvers
def test_inequalities_on_two_levels_and_a_conflicting_third(qp_solver: QpSolver) -> None:
    levels = conflicting_third()
    solution = solve_cascade(levels, qp_solver=qp_solver)
    assert solution.status is CascadeStatus.SOLVED
    np.testing.assert_allclose(solution.x, [1.0, 4.0, 7.0], atol=2e-3)
    assert solution.residual_norms["first"] < 2e-3
    assert solution.residual_norms["second"] == pytest.approx(np.hypot(2.0, 0.5), abs=5e-3)


def test_the_lexicographic_method_agrees_on_the_conflicting_third() -> None:
    solution = solve_hierarchy(conflicting_third())
    np.testing.assert_allclose(solution.x, [1.0, 4.0, 7.0], atol=1e-12)


@pytest.mark.parametrize("qp_solver", ACCURATE)
def test_random_hierarchies_agree_or_are_counted(qp_solver: QpSolver) -> None:
    """Where no program failed, no level is better or worse than the certified solution but for degenerate cases."""
    counted, differ, total = 0, 0, 60
    for seed in range(total):
        levels = random_hierarchy(seed, max_levels=5)
        solution = solve_cascade(levels, qp_solver=qp_solver)
        assert np.isfinite(solution.x).all()
        assert (solution.status is CascadeStatus.QP_FAILED) == bool(solution.failures)
        counted += bool(solution.failures)
        differ += not solution.failures and first_difference(levels, solution.x) != 0.0
    assert counted <= 0.25 * total
    assert differ <= 0.05 * total


@pytest.mark.parametrize("seed", range(20))
def test_equalities_alone_equal_the_lexicographic_solution(seed: int) -> None:
    """Without inequalities there is nothing fragile: null spaces alone, Eq. (12)."""
    rng = np.random.default_rng(seed)
    levels = [
        equality(f"level {index}", rng.normal(size=(count, DIMENSION)), rng.normal(size=count))
        for index, count in enumerate((3, 0, 4, 5, 6))
    ]
    levels.insert(2, equality("dependent", 2.0 * levels[0].matrix, rng.normal(size=3)))
    solution = solve_cascade(levels)
    assert solution.failures == {}
    np.testing.assert_allclose(solution.x, solve_hierarchy(levels).x, atol=1e-5 * np.abs(solution.x).max())
    assert solution.programs == 4, "an empty level and one without freedom left need no program"


def test_three_opinions_on_random_hierarchies() -> None:
    """Where cascade and DAQP's hierarchical mode both report success they agree with the certified solution."""
    agree = 0
    for seed in range(60):
        levels = random_hierarchy(seed, max_levels=3)
        x, solved = solve_daqp_hierarchical(levels)
        printed = solve_cascade(levels)
        ours = solve_hierarchy(levels)
        assert certificate(levels, ours.x).max() < 1e-6
        if solved and not printed.failures:
            agree += first_difference(levels, x) == 0.0 and first_difference(levels, printed.x) == 0.0
    assert agree >= 50


def test_a_program_that_fails_is_named_and_leaves_the_point_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """The level is skipped, higher levels stay solved, its slacks are frozen where they are."""
    honest, calls = qpsolvers.solve_problem, itertools.count(1)

    def fails_at_the_second(problem: qpsolvers.Problem, solver: str) -> qpsolvers.Solution:
        if next(calls) == 2:
            raise qpsolvers.exceptions.SolverError("no luck")
        return honest(problem, solver=solver)

    monkeypatch.setattr(qpsolvers, "solve_problem", fails_at_the_second)
    solution = solve_cascade(conflicting_third())
    assert solution.status is CascadeStatus.QP_FAILED
    assert solution.failures == {"second": "daqp: no luck"}
    assert solution.residual_norms["first"] < 1e-6
    assert solution.x[2] == pytest.approx(7.0, abs=1e-6), "the third level still gets what is left"


def test_a_back_end_that_lies_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """A point that is not optimal is a failure, whatever the back end says of it."""
    honest = qpsolvers.solve_problem

    def shifted(problem: qpsolvers.Problem, solver: str) -> qpsolvers.Solution:
        solution = honest(problem, solver=solver)
        assert solution.x is not None
        solution.x = solution.x + 0.1
        return solution

    monkeypatch.setattr(qpsolvers, "solve_problem", shifted)
    solution = solve_cascade(conflicting_third())
    assert set(solution.failures) == {"first", "second", "third"}
    assert all("residual" in reason for reason in solution.failures.values())
    np.testing.assert_array_equal(solution.x, 0.0)


def test_mistakes_of_the_caller_are_named() -> None:
    for levels, start, message in (
        ([], None, "at least one"),
        (conflicting_third(), np.zeros(2), "start"),
        (conflicting_third(), np.array([0.0, np.nan, 0.0]), "start"),
    ):
        with pytest.raises(HierarchyError, match=message):
            solve_cascade(levels, start)


def test_same_problem_gives_same_bits() -> None:
    first, second = (solve_cascade(random_hierarchy(3)) for _ in range(2))
    assert isinstance(first, CascadeSolution)
    assert first.x.tobytes() == second.x.tobytes()
