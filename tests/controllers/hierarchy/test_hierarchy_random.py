"""Promises that hold for every hierarchy, tried on random ones."""

import numpy as np
import pytest

from quadlab.controllers.hierarchy import HierarchyStatus, Level, certificate, solve_hierarchy
from quadlab.controllers.hierarchy.random_hierarchy import DIMENSION, random_hierarchy

OPTIMAL = 1e-6


def failures(seeds: range, max_levels: int = 11) -> list[int]:
    """Return the seeds whose solution is not certified."""
    failed = []
    for seed in seeds:
        levels = random_hierarchy(seed, max_levels=max_levels)
        solution = solve_hierarchy(levels)
        if solution.status is not HierarchyStatus.SOLVED or certificate(levels, solution.x).max() > OPTIMAL:
            failed.append(seed)
    return failed


def test_every_random_hierarchy_is_certified() -> None:
    assert failures(range(500)) == []


@pytest.mark.parametrize("seed", [5402, 22806, 24969, 26517])
def test_the_certificate_counts_tiny_violations(seed: int) -> None:
    """Optimal points that violate a row by 1e-6 to 1e-4: dropping such a slack looks like a wrong solution."""
    levels = random_hierarchy(seed)
    assert certificate(levels, solve_hierarchy(levels).x).max() < 1e-12


def test_certificate_rejects_a_point_that_is_slightly_off() -> None:
    rng = np.random.default_rng(3)
    for seed in range(100):
        levels = [*random_hierarchy(seed), Level("rest", np.eye(DIMENSION), np.zeros(DIMENSION), np.zeros(DIMENSION))]
        off = solve_hierarchy(levels).x + 1e-4 * rng.normal(size=DIMENSION)
        assert certificate(levels, off).max() > OPTIMAL


def test_certificate_rejects_swapped_priorities() -> None:
    """Solutions of the same levels in another order are told apart wherever their residuals differ."""
    told = 0
    for seed in range(100):
        levels = random_hierarchy(seed)
        right, swapped = solve_hierarchy(levels), solve_hierarchy(levels[::-1])
        gap = max(abs(right.residual_norms[each.name] - swapped.residual_norms[each.name]) for each in levels)
        if gap > 1e-3:
            assert certificate(levels, swapped.x).max() > OPTIMAL
            told += 1
    assert told > 30


@pytest.mark.parametrize("seed", range(60))
def test_a_lower_level_never_costs_a_higher_one(seed: int) -> None:
    levels = random_hierarchy(seed)
    whole = solve_hierarchy(levels).residual_norms
    for count in range(1, len(levels)):
        part = solve_hierarchy(levels[:count]).residual_norms
        for name, norm in part.items():
            assert whole[name] == pytest.approx(norm, abs=1e-7)


@pytest.mark.parametrize("seed", range(60))
def test_the_warm_start_does_not_move_the_residuals(seed: int) -> None:
    levels = random_hierarchy(seed)
    cold = solve_hierarchy(levels)
    rng = np.random.default_rng(seed)
    for start in (cold.x, cold.x + 0.1 * rng.normal(size=DIMENSION), 10.0 * rng.normal(size=DIMENSION)):
        warm = solve_hierarchy(levels, start)
        assert certificate(levels, warm.x).max() < OPTIMAL
        for name, norm in cold.residual_norms.items():
            assert warm.residual_norms[name] == pytest.approx(norm, abs=1e-7)


def test_the_own_solution_as_start_stays() -> None:
    for seed in range(60):
        levels = random_hierarchy(seed)
        cold = solve_hierarchy(levels)
        warm = solve_hierarchy(levels, cold.x)
        np.testing.assert_allclose(warm.x, cold.x, atol=1e-7 * max(1.0, float(np.linalg.norm(cold.x))))


@pytest.mark.parametrize("seed", range(40))
def test_undecided_freedom_goes_to_the_minimiser_closest_to_the_start(seed: int) -> None:
    levels = random_hierarchy(seed, max_levels=4)
    start = np.random.default_rng(seed).normal(size=DIMENSION)
    explicit = solve_hierarchy([*levels, Level("start", np.eye(DIMENSION), start, start)])
    np.testing.assert_allclose(solve_hierarchy(levels, start).x, explicit.x, atol=1e-7)


def test_same_problem_gives_same_bits() -> None:
    for seed in range(30):
        levels = random_hierarchy(seed)
        assert solve_hierarchy(levels).x.tobytes() == solve_hierarchy(levels).x.tobytes()


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_the_unit_of_the_unknowns_scales_the_solution(factor: float) -> None:
    for seed in range(40):
        levels = random_hierarchy(seed, max_levels=5)
        scaled = [Level(each.name, each.matrix / factor, each.lower, each.upper) for each in levels]
        solution, reference = solve_hierarchy(scaled), solve_hierarchy(levels)
        for name, norm in reference.residual_norms.items():
            assert solution.residual_norms[name] == pytest.approx(norm, abs=1e-5)


@pytest.mark.parametrize("exponent", [-200, -12, 12, 200])
def test_extreme_but_finite_numbers_give_a_finite_answer(exponent: int) -> None:
    for seed in range(30):
        rng = np.random.default_rng(seed)
        levels = [
            Level(
                each.name,
                each.matrix * 10.0 ** (exponent * rng.random((len(each.lower), 1))),
                each.lower * 10.0 ** (exponent * rng.random(len(each.lower))),
                np.full(len(each.lower), np.inf),
            )
            for each in random_hierarchy(seed)
        ]
        assert np.isfinite(solve_hierarchy(levels).x).all()
