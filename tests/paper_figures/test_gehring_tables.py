"""Costs are judged by their ratio, patterns by the samples they need, alignments by what they lay where."""

import numpy as np
import pandas as pd
import pytest

from paper_figures.gehring2017.figure2_alignment import Moment
from paper_figures.gehring2017.figure3_contact_schedules import contacts, cycles, fewest_samples
from paper_figures.gehring2017.table1_objectives import largest_gap, within


@pytest.mark.parametrize(("ratio", "close"), [(1.0, True), (0.34, True), (2.9, True), (0.3, False), (3.1, False)])
def test_a_factor_counts_both_ways(ratio: float, close: bool) -> None:
    assert within(ratio, 3.0) is close


def test_largest_gap_of_a_distance_is_told_in_millimetres() -> None:
    rows = pd.DataFrame(
        [("smooth_base", 1e2, 2.8, 5.57), ("travel_distance_transition", 1e3, 0.4, 11.95)],
        columns=["objective", "weight", "cost", "paper"],
    )
    assert "misses its distance by 109 mm there, 20 mm here" in largest_gap(rows)
    assert largest_gap(rows[:1]) == "Farthest apart: smooth base motion, 5.57 printed, 2.8 here."


@pytest.mark.parametrize("repeats", [1, 2, 5])
def test_finer_samples_are_not_needed(repeats: int) -> None:
    stands = contacts(cycles("walk"))
    assert fewest_samples(np.repeat(stands, repeats, axis=0)) == len(stands)


def test_halves_need_two_samples() -> None:
    assert fewest_samples(np.repeat(np.eye(2, 4, dtype=bool), 8, axis=0)) == 2


def test_the_controller_mixes_its_reference_with_base_centred_feet() -> None:
    feet = np.array([[0.3, 0.2], [0.3, -0.2], [-0.3, 0.2], [-0.3, -0.2]])
    now = Moment(np.array([0.1, -0.1]), feet, 0.0, np.array([0.0, -0.03]), np.zeros(2), feet, 0.0)
    com, laid = now.laid()["mixed"]
    np.testing.assert_allclose(com, [0.0, -0.03])
    np.testing.assert_allclose(laid, feet + np.array([0.1, -0.1]))
