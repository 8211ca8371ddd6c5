"""Results of trials become one table."""

import shutil
from pathlib import Path

import pytest

from quadlab.analysis.trial_table import read_trial_table
from quadlab.errors import LogError
from quadlab.trials.result import TrialResult, TrialStatus, write_result


def _result(trial_id: str, status: TrialStatus, speed: float | None) -> TrialResult:
    return TrialResult(
        trial_id=trial_id,
        status=status,
        status_reason="as planned",
        robot="box",
        gait="trot",
        planner="vertex_zmp",
        controller="hierarchical",
        estimator="truth",
        scenario="flat",
        seed=0,
        duration_s=4.0,
        mean_speed_mps=speed,
    )


def test_every_trial_is_a_row_failures_included(tmp_path: Path) -> None:
    write_result(tmp_path / "b", _result("b", TrialStatus.COMPLETED, 0.3))
    write_result(tmp_path / "a", _result("a", TrialStatus.PLANNING_FAILED, None))
    table = read_trial_table(tmp_path)
    assert table.index.tolist() == ["a", "b"]
    assert table["status"].tolist() == ["planning_failed", "completed"]
    assert table["mean_speed_mps"].isna().tolist() == [True, False]
    assert table["mean_speed_mps"].iloc[1] == 0.3


def test_an_empty_folder_and_a_copied_trial_are_clear_errors(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"no result\.json"):
        read_trial_table(tmp_path)
    write_result(tmp_path / "a", _result("a", TrialStatus.COMPLETED, 0.3))
    shutil.copytree(tmp_path / "a", tmp_path / "copy_of_a")
    with pytest.raises(LogError, match="'a' exists more than once"):
        read_trial_table(tmp_path)
