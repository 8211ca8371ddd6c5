"""Cases with the same limit are all seen: their dots lie beside each other in the bar of their variant."""

import pandas as pd
import pytest

from paper_figures.comparison.ablations import DOT_ROWS, stacked


def test_dots_of_equal_value_are_apart_and_centred() -> None:
    offsets = stacked(pd.Series([0.2, 0.5, 0.2, 0.2]))
    assert offsets.tolist() == pytest.approx([-DOT_ROWS, 0.0, 0.0, DOT_ROWS])


def test_single_dots_stay_in_the_middle() -> None:
    assert not stacked(pd.Series([0.1, 0.2, 0.3])).any()
