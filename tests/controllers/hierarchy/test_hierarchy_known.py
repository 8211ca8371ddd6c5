"""Hierarchies whose answer is known from elsewhere: by hand, in closed form, or from a quadratic program."""

import numpy as np
import pytest
import qpsolvers

from quadlab.controllers.hierarchy import HierarchyStatus, Level, certificate, solve_hierarchy
from quadlab.geometry.rotations import Array

OPEN = np.inf


def equality(name: str, matrix: Array, target: Array) -> Level:
    return Level(name, matrix, target, target)


def test_inequalities_on_two_levels_and_a_conflicting_third() -> None:
    # x <= 1 comes first; x >= 2 can then only come as close as x = 1; x = 5, y = 3 must not undo either of them.
    levels = [
        Level("first", np.array([[1.0, 0.0]]), np.array([-OPEN]), np.array([1.0])),
        Level("second", np.array([[1.0, 0.0]]), np.array([2.0]), np.array([OPEN])),
        equality("third", np.eye(2), np.array([5.0, 3.0])),
    ]
    solution = solve_hierarchy(levels)
    np.testing.assert_allclose(solution.x, [1.0, 3.0], atol=1e-12)
    assert solution.residual_norms == pytest.approx({"first": 0.0, "second": 1.0, "third": 4.0})
    assert solution.slacks["second"] == pytest.approx([-1.0])
    assert [int(solution.active[name][0]) for name in ("first", "second", "third")] == [1, -1, 2]


def test_inequalities_on_two_levels_bind_together() -> None:
    # Level 1 keeps x + y <= 2, level 2 keeps x >= 1.5; the target (0, 4) projects on their corner (1.5, 0.5).
    levels = [
        Level("sum", np.array([[1.0, 1.0]]), np.array([-OPEN]), np.array([2.0])),
        Level("side", np.array([[1.0, 0.0]]), np.array([1.5]), np.array([OPEN])),
        equality("target", np.eye(2), np.array([0.0, 4.0])),
    ]
    solution = solve_hierarchy(levels)
    np.testing.assert_allclose(solution.x, [1.5, 0.5], atol=1e-12)
    assert solution.residual_norms["sum"] == solution.residual_norms["side"] == 0.0


def test_swapped_priorities_swap_who_is_violated() -> None:
    below = Level("below", np.array([[1.0]]), np.array([-OPEN]), np.array([1.0]))
    above = Level("above", np.array([[1.0]]), np.array([2.0]), np.array([OPEN]))
    assert solve_hierarchy([below, above]).x == pytest.approx([1.0])
    assert solve_hierarchy([above, below]).x == pytest.approx([2.0])


def test_violations_of_one_level_are_shared_in_the_least_squares_sense() -> None:
    # min (x - 1)^2 + 4 (x - 3)^2 over 1 <= x <= 3, from x <= 1 and 2 x >= 6 with weight 2.
    level = Level("both", np.array([[1.0], [2.0]]), np.array([-OPEN, 6.0]), np.array([1.0, OPEN]))
    assert solve_hierarchy([level]).x == pytest.approx([13.0 / 5.0])


@pytest.mark.parametrize("seed", range(20))
def test_equalities_alone_follow_the_recursive_null_space_solution(seed: int) -> None:
    rng = np.random.default_rng(seed)
    levels = [
        equality(f"level {index}", rng.normal(size=(count, 12)), rng.normal(size=count))
        for index, count in enumerate([3, 0, 4, 2])
    ]
    levels.insert(2, equality("dependent", 2.0 * levels[0].matrix, rng.normal(size=3)))
    x, null = np.zeros(12), np.eye(12)
    for level in levels:
        reduced = level.matrix @ null
        reduced[np.abs(reduced) < 1e-12] = 0.0  # or the pseudo-inverse inverts the rounding errors of dependent rows
        x = x + null @ np.linalg.pinv(reduced, rcond=1e-9) @ (level.lower - level.matrix @ x)
        _, sizes, directions = np.linalg.svd(reduced)
        null = null @ directions[int((sizes > 1e-9).sum()) :].T
    np.testing.assert_allclose(solve_hierarchy(levels).x, x, atol=1e-10)


def test_box_above_a_target_clips_it() -> None:
    target = np.linspace(-3.0, 3.0, 12)
    box = Level("box", np.eye(12), np.full(12, -1.0), np.full(12, 2.0))
    solution = solve_hierarchy([box, equality("target", np.eye(12), target)])
    np.testing.assert_allclose(solution.x, np.clip(target, -1.0, 2.0), atol=1e-14)
    np.testing.assert_array_equal(solution.active["box"], np.sign(target) * (solution.x != target))


@pytest.mark.parametrize("seed", range(40))
def test_hard_inequality_over_least_squares_is_a_quadratic_program(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows, feasible = rng.normal(size=(20, 12)), rng.normal(size=12)
    lower, upper = rows @ feasible - rng.random(20), rows @ feasible + rng.random(20)
    task, target = rng.normal(size=(14, 12)), 5.0 * rng.normal(size=14)
    solution = solve_hierarchy([Level("hard", rows, lower, upper), equality("task", task, target)])
    reference = qpsolvers.solve_qp(
        task.T @ task, -task.T @ target, np.vstack([rows, -rows]), np.concatenate([upper, -lower]), solver="daqp"
    )
    assert reference is not None
    assert solution.residual_norms["hard"] < 1e-8
    np.testing.assert_allclose(solution.x, reference, atol=1e-6)


def test_no_freedom_left_and_nothing_to_do() -> None:
    x = np.arange(1.0, 5.0)
    levels = [equality("all", np.eye(4), x), equality("late", np.ones((2, 4)), np.zeros(2))]
    solution = solve_hierarchy(levels)
    np.testing.assert_allclose(solution.x, x, atol=1e-14)
    np.testing.assert_allclose(solution.slacks["late"], [10.0, 10.0])
    empty = Level("empty", np.zeros((0, 4)), np.zeros(0), np.zeros(0))
    nothing = solve_hierarchy([empty], start=x)
    np.testing.assert_array_equal(nothing.x, x)
    assert nothing.slacks["empty"].shape == (0,)


def test_zero_rows_keep_their_slack_and_change_nothing() -> None:
    zero = Level("zero", np.zeros((2, 3)), np.array([1.0, -OPEN]), np.array([1.0, -2.0]))
    solution = solve_hierarchy([zero, equality("target", np.eye(3), np.ones(3))])
    np.testing.assert_allclose(solution.x, 1.0)
    np.testing.assert_allclose(solution.slacks["zero"], [-1.0, 2.0])
    assert certificate([zero], solution.x).max() < 1e-12


def test_iteration_limit_is_reported_and_keeps_finished_levels() -> None:
    box = Level("box", np.eye(12), np.full(12, -1.0), np.full(12, 1.0))
    mixing = np.random.default_rng(0).normal(size=(12, 12))
    levels = [box, equality("target", mixing, np.full(12, 50.0))]
    full = solve_hierarchy(levels)
    assert full.status is HierarchyStatus.SOLVED
    costs = []
    for limit in range(1, full.iterations):
        stopped = solve_hierarchy(levels, iteration_limit=limit)
        assert stopped.status is HierarchyStatus.ITERATION_LIMIT
        assert stopped.iterations == limit
        assert stopped.residual_norms["box"] < 1e-9
        costs.append(stopped.residual_norms["target"])
    assert (np.diff([*costs, full.residual_norms["target"]]) <= 1e-9).all()
