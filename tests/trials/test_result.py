"""Results survive the way through their file, and a half-written one is never seen."""

import json
import math
from pathlib import Path

import pytest
from pydantic import ValidationError

from quadlab.errors import LogError
from quadlab.trials.files import write_json, write_text
from quadlab.trials.result import RESULT_FILE, TrialResult, TrialStatus, read_result, write_result

REQUIRED = [
    "schema_version",
    "trial_id",
    "status",
    "status_reason",
    "robot",
    "gait",
    "planner",
    "controller",
    "estimator",
    "scenario",
    "seed",
    "duration_s",
    "survived_s",
    "distance_m",
    "mean_speed_mps",
    "com_error_rms_mm",
    "com_error_max_mm",
    "base_height_rms_mm",
    "roll_pitch_rms_deg",
    "foot_slip_max_mm",
    "torque_max_nm",
    "torque_limit_share",
    "cost_of_transport",
    "planning_build_ms",
    "planning_solve_ms",
    "planning_iterations",
    "control_tick_median_us",
    "control_tick_p99_us",
    "control_fallbacks",
    "real_time_factor",
    "state_sha256",
]


def _result(**changes: object) -> TrialResult:
    values: dict[str, object] = {
        "trial_id": "0123456789abcdef",
        "status": "fell",
        "status_reason": "fell at 3.21 s: base tilted by 45 deg",
        "robot": "anymal_b",
        "gait": "trot",
        "planner": "vertex_zmp",
        "controller": "hierarchical",
        "estimator": "truth",
        "scenario": "push",
        "seed": 3,
        "duration_s": 10.0,
        "survived_s": 3.21,
        "com_error_max_mm": 1.0 / 3.0,
    }
    return TrialResult.model_validate(values | changes)


def test_round_trip_keeps_every_digit(tmp_path: Path) -> None:
    write_result(tmp_path, _result())
    assert read_result(tmp_path) == _result()


def test_file_is_one_flat_object_with_every_field(tmp_path: Path) -> None:
    row = json.loads(write_result(tmp_path, _result()).read_text())
    assert set(REQUIRED) <= set(row)
    assert not [key for key, value in row.items() if isinstance(value, dict | list)]
    assert row["status"] == "fell"
    assert row["planning_solve_ms"] is None


@pytest.mark.parametrize("changes", [{"survived_s": math.nan}, {"cost_of_transport": math.inf}, {"status": "ok"}])
def test_numbers_that_are_not_finite_and_unknown_outcomes_are_refused(changes: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        _result(**changes)


def test_missing_result_says_so(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"result\.json: not found"):
        read_result(tmp_path)


@pytest.mark.parametrize(
    ("text", "expected"), [('{"trial_id": "x', "not JSON"), ('{"schema_version": 9}', "not a result of schema 1")]
)
def test_foreign_or_broken_result_says_so(text: str, expected: str, tmp_path: Path) -> None:
    (tmp_path / RESULT_FILE).write_text(text)
    with pytest.raises(LogError, match=expected):
        read_result(tmp_path)


def test_result_that_is_not_text_or_cannot_be_opened_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / RESULT_FILE
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(LogError, match=r"result\.json: not JSON \('utf-8' codec"):
        read_result(tmp_path)

    def refuse(*_: object, **__: object) -> str:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_text", refuse)
    with pytest.raises(LogError, match=r"result\.json: Permission denied"):
        read_result(tmp_path)


def test_failed_write_leaves_the_old_file_and_no_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.json"
    write_json(path, {"x": 1})

    def full_disk(*_: object) -> None:
        raise OSError("no space left")

    monkeypatch.setattr("quadlab.trials.files.os.replace", full_disk)
    with pytest.raises(OSError, match="no space"):
        write_text(path, "half")
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_json(path, {"x": math.nan})
    assert json.loads(path.read_text()) == {"x": 1}
    assert list(tmp_path.iterdir()) == [path]


def test_statuses_are_lower_case_words() -> None:
    assert all(status.value == status.name.lower() for status in TrialStatus)
