"""Mistakes of the caller get one clear line; the stacked form is the same solver."""

import numpy as np
import pytest

from quadlab.controllers.hierarchy import HierarchyError, Level, solve_hierarchy, solve_stacked, stack
from quadlab.controllers.hierarchy.random_hierarchy import random_hierarchy
from quadlab.errors import QuadlabError


def one_row(**changed: object) -> Level:
    fields: dict[str, object] = {"matrix": np.ones((1, 2)), "lower": np.zeros(1), "upper": np.ones(1)}
    return Level("task", **{**fields, **changed})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"matrix": np.array([[1.0, np.nan]])}, "finite"),
        ({"matrix": np.array([[1.0, np.inf]])}, "finite"),
        ({"lower": np.array([np.nan])}, "finite or open"),
        ({"lower": np.array([np.inf]), "upper": np.array([np.inf])}, "finite or open"),
        ({"upper": np.array([-np.inf]), "lower": np.array([-np.inf])}, "finite or open"),
        ({"lower": np.array([2.0])}, "above upper"),
        ({"lower": np.zeros(2)}, r"lower must have shape \(1,\)"),
        ({"matrix": np.ones(2)}, r"matrix must be \(m, n\)"),
    ],
)
def test_a_malformed_level_is_an_error_that_names_it(changed: dict[str, object], message: str) -> None:
    with pytest.raises(HierarchyError, match=message) as caught:
        one_row(**changed)
    assert "'task'" in str(caught.value)
    assert "\n" not in str(caught.value)
    assert isinstance(caught.value, QuadlabError)
    assert isinstance(caught.value, ValueError)


def test_levels_that_do_not_fit_together_are_an_error() -> None:
    wide = Level("wide", np.ones((1, 3)), np.zeros(1), np.zeros(1))
    for levels, message in (([], "at least one"), ([one_row(), wide], "columns"), ([one_row(), one_row()], "differ")):
        with pytest.raises(HierarchyError, match=message):
            solve_hierarchy(levels)


@pytest.mark.parametrize("start", [np.zeros(3), np.array([0.0, np.nan])])
def test_an_unusable_start_is_an_error(start: np.ndarray) -> None:
    with pytest.raises(HierarchyError, match="start"):
        solve_hierarchy([one_row()], start)


def test_an_unusable_limit_is_an_error() -> None:
    with pytest.raises(HierarchyError, match="iteration_limit"):
        solve_hierarchy([one_row()], iteration_limit=0)


def test_stacked_and_named_forms_agree_and_leave_their_input_alone() -> None:
    for seed in range(20):
        levels = random_hierarchy(seed)
        stacked = stack(levels)
        before = stacked.matrix.copy(), stacked.lower.copy(), stacked.upper.copy()
        start = np.ones(12)
        result = solve_stacked(*stacked, start, 500)
        named = solve_hierarchy(levels, start)
        np.testing.assert_array_equal(result.x, named.x)
        np.testing.assert_array_equal(result.slacks, np.concatenate(list(named.slacks.values())))
        np.testing.assert_array_equal(result.active, np.concatenate(list(named.active.values())))
        np.testing.assert_allclose(result.norms, list(named.residual_norms.values()), atol=1e-15)
        assert (result.iterations, result.status) == (named.iterations, 0)
        for array, copy in zip((stacked.matrix, stacked.lower, stacked.upper), before, strict=True):
            np.testing.assert_array_equal(array, copy)
        np.testing.assert_array_equal(start, 1.0)
