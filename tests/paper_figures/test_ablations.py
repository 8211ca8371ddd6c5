"""Cases with the same limit are all seen: their dots lie beside each other in the bar of their variant."""

from pathlib import Path

import pandas as pd
import pytest

from paper_figures.comparison.ablations import DOT_ROWS, claims, stacked
from quadlab.analysis.study_results import StudyResults
from quadlab.errors import LogError


def test_dots_of_equal_value_are_apart_and_centred() -> None:
    offsets = stacked(pd.Series([0.2, 0.5, 0.2, 0.2]))
    assert offsets.tolist() == pytest.approx([-DOT_ROWS, 0.0, 0.0, DOT_ROWS])


def test_single_dots_stay_in_the_middle() -> None:
    assert not stacked(pd.Series([0.1, 0.2, 0.3])).any()


def test_limits_of_when_pushes_were_all_there_was_are_one_line(tmp_path: Path) -> None:
    (tmp_path / "ablations").mkdir()
    pd.DataFrame({"variant": ["reference"], "limit": [380.0]}).to_csv(tmp_path / "ablations" / "limits.csv")
    with pytest.raises(LogError, match=r"no column 'disturbance', .*; python experiments/run_study.py ablations makes"):
        claims(StudyResults(tmp_path))
