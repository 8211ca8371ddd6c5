"""The table of all trials: typed, sorted, with what was varied, and with the failures."""

from pathlib import Path

import pandas as pd
import pytest
from trial_folders import COMMIT, begin, fail, finish

from quadlab.analysis.collect import collect_trials, varied_values, write_collected
from quadlab.errors import LogError
from quadlab.trials.result import TrialStatus


def test_failures_are_rows_with_names_and_reason(tmp_path: Path) -> None:
    finish(tmp_path, "seed=1")
    finish(tmp_path, "seed=2", status=TrialStatus.FELL, com_error_rms_mm=None)
    dead = fail(tmp_path, "seed=3", "gait=pace")
    broken = finish(tmp_path, "seed=4")
    (broken / "result.json").write_text('{"half')
    begin(tmp_path, "seed=5")
    table = collect_trials(tmp_path)
    assert list(table.index) == sorted(table.index)
    assert sorted(table["status"]) == ["completed", "error", "error", "fell"]
    columns = ("status_reason", "gait", "seed")
    assert [table.loc[dead.name, column] for column in columns] == ["died: killed by SIGKILL", "pace", 3]
    assert "not JSON" in str(table.loc[broken.name, "status_reason"])
    assert set(table["commit"]) == {COMMIT}


@pytest.mark.parametrize(
    ("file", "content"),
    [
        ("result.json", b"\xff\xfe"),
        ("manifest.json", b'{"git": "abc"}'),
        ("manifest.json", b'{"git": {"commit": 5}}'),
        ("config.yaml", b"robot: anymal_b\nestimator: [1]\nseed: abc\nduration_s: [2]"),
        ("config.yaml", b"\xff\xfe"),
    ],
)
def test_one_damaged_file_costs_no_row_and_no_other_trial(tmp_path: Path, file: str, content: bytes) -> None:
    finish(tmp_path, "seed=1")
    damaged = finish(tmp_path, "seed=2")
    (damaged / "result.json").write_text("{")
    (damaged / file).write_bytes(content)
    table = collect_trials(tmp_path)
    assert sorted(table["status"]) == ["completed", "error"]
    assert table.loc[damaged.name, "robot"] in ("anymal_b", "unknown")


def test_types_survive_missing_values_and_parquet(tmp_path: Path) -> None:
    finish(tmp_path, "seed=1", "controller=weighted")
    fail(tmp_path, "seed=2", "controller.rate_hz=200")
    table = collect_trials(tmp_path)
    kinds = {"seed": "Int64", "com_error_rms_mm": "Float64", "control_fallbacks": "Int64", "status": "string"}
    assert {name: str(table[name].dtype) for name in kinds} == kinds
    assert str(table["controller.rate_hz"].dtype) == "Float64"
    parquet, csv = write_collected(table, tmp_path)
    pd.testing.assert_frame_equal(pd.read_parquet(parquet), table, check_index_type=False)
    assert list(pd.read_csv(csv)["trial_id"]) == list(table.index)
    assert not list(tmp_path.glob("*.part"))


def test_only_what_differs_becomes_a_column() -> None:
    configs = [
        {"a": {"b": 1, "c": True}, "same": 3, "list": [1, {"x": 2.0}]},
        {"a": {"b": 2.5, "c": None}, "same": 3, "list": [1, {"x": 3.0}]},
    ]
    table = varied_values(configs)
    assert {name: str(column.dtype) for name, column in table.items()} == {
        "a.b": "Float64",
        "a.c": "boolean",
        "list.1.x": "Float64",
    }


def test_same_trial_in_two_folders_is_refused(tmp_path: Path) -> None:
    finish(tmp_path, "seed=1", "tag=one")
    finish(tmp_path, "seed=1", "tag=two")
    with pytest.raises(LogError, match="are the same trial"):
        collect_trials(tmp_path)
    assert len(collect_trials(tmp_path / "one")) == 1


def test_nothing_to_collect_is_an_error(tmp_path: Path) -> None:
    begin(tmp_path, "seed=1")
    with pytest.raises(LogError, match="no trial in it has an outcome yet"):
        collect_trials(tmp_path)
    with pytest.raises(LogError, match="no such folder"):
        collect_trials(tmp_path / "nowhere")
