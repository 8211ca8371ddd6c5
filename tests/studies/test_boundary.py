"""The search finds the limit of whatever has one, and admits where it has none."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadlab.studies.boundary import BoundarySearch
from quadlab.studies.config import SearchConfig


def _search(confirm: int = 0) -> BoundarySearch:
    return BoundarySearch(SearchConfig(key="force", lowest=20.0, step=10.0, highest=200.0, confirm=confirm))


def _run(search: BoundarySearch, largest: float) -> None:
    while (value := search.next_value()) is not None:
        search.record(value, value <= largest)


@given(st.floats(0.0, 300.0), st.integers(0, 3))
def test_limit_is_the_largest_grid_value_that_is_survived(largest: float, confirm: int) -> None:
    search = _search(confirm)
    _run(search, largest)
    survived = [value for value in search.grid if value <= largest]
    assert search.limit == (survived[-1] if survived else None)
    assert search.monotone is (True if confirm and len(survived) > 1 else None)


def test_bisection_needs_few_probes() -> None:
    search = _search()
    _run(search, 90.0)
    assert len(search.outcomes) <= 5  # of 19 grid values


def test_failure_below_the_limit_is_found_and_lowers_it() -> None:
    search = _search(confirm=3)
    while (value := search.next_value()) is not None:
        search.record(value, value <= 150.0 and value != 120.0)
    assert search.limit == 110.0
    assert search.monotone is False


def test_value_that_could_not_be_tried_ends_the_search_without_a_limit() -> None:
    search = _search(confirm=1)
    search.record(110.0, survived=True)
    search.give_up("the process was killed")
    assert (search.next_value(), search.limit, search.monotone) == (None, None, None)


@pytest.mark.parametrize(("largest", "limit"), [(0.0, None), (1000.0, 200.0)])
def test_ends_of_the_grid(largest: float, limit: float | None) -> None:
    search = _search()
    _run(search, largest)
    assert search.limit == limit
