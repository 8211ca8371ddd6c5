"""Studies run what is missing and nothing else; what fails is a row."""

from io import StringIO
from pathlib import Path

import pandas as pd
import pytest
import yaml

from quadlab.analysis.study_results import StudyResults
from quadlab.errors import ConfigurationError, LogError
from quadlab.studies import config as study_config
from quadlab.studies.progress import StudyProgress
from quadlab.studies.runner import run_studies

STUDY = {
    "title": "A robot that stands",
    "blocks": [{"overrides": ["gait=stand", "command=in_place", "duration_s=1.2"], "factors": {"seed": [0, 1]}}],
    "traces": [{"name": "first", "where": {"seed": 0}, "columns": ["state.base_position_*"], "rate_hz": 50}],
    "report_by": ["seed"],
    "report_columns": ["com_error_max_mm"],
}


@pytest.fixture
def study_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of studies with one in it; only the search for studies looks there."""
    folder = tmp_path / "conf" / "study"
    folder.mkdir(parents=True)
    (folder / "standing.yaml").write_text(yaml.safe_dump(STUDY))
    monkeypatch.setattr(study_config, "CONF_DIR", tmp_path / "conf")
    return folder


def _run(results: Path) -> str:
    output = StringIO()
    assert run_studies(["standing"], results, 1, StudyProgress(output)) == 0
    return output.getvalue()


def test_second_run_does_nothing_and_a_deleted_result_is_made_again(study_folder: Path, tmp_path: Path) -> None:
    results = tmp_path / "results"
    assert _run(results).count("completed") == 2
    table = (results / "standing" / "table.csv").read_text()
    assert _run(results) == ""
    frame = pd.read_csv(results / "standing" / "table.csv")
    (results / "standing" / str(frame["directory"][1]) / "result.json").unlink()
    assert _run(results).count("completed") == 1
    again = pd.read_csv(results / "standing" / "table.csv")
    assert list(again["state_sha256"]) == list(pd.read_csv(StringIO(table))["state_sha256"])
    assert list(again["log_sha256"]) == list(frame["log_sha256"])


def test_what_figures_need_is_kept(study_folder: Path, tmp_path: Path) -> None:
    _run(tmp_path / "results")
    results = StudyResults(tmp_path / "results")
    trace = results.trace("standing", "first")
    assert list(trace.columns) == [f"state.base_position_{axis}" for axis in "xyz"]
    assert len(trace) == 60
    assert results.plan("standing", "first").duration_s == pytest.approx(1.2)
    with pytest.raises(LogError, match=r"limits.csv: not there; python experiments/run_study.py standing makes it"):
        results.limits("standing")


def test_curves_are_made_again_if_others_are_asked_for(study_folder: Path, tmp_path: Path) -> None:
    _run(tmp_path / "results")
    text = yaml.safe_dump(STUDY).replace("state.base_position_*", "state.base_quat_?")
    (study_folder / "standing.yaml").write_text(text)
    _run(tmp_path / "results")
    kept = StudyResults(tmp_path / "results").trace("standing", "first")
    assert list(kept.columns) == [f"state.base_quat_{axis}" for axis in "wxyz"]


def test_curves_that_do_not_exist_are_said(study_folder: Path, tmp_path: Path) -> None:
    text = yaml.safe_dump(STUDY).replace("state.base_position_*", "state.base_positoin_x")
    (study_folder / "standing.yaml").write_text(text)
    output = StringIO()
    assert run_studies(["standing"], tmp_path / "results", 1, StudyProgress(output)) == 1
    line = "error: trace 'first': no column 'state.base_positoin_x'; did you mean 'state.base_position_x'"
    assert line in output.getvalue()


STANDING = ["command=in_place", "duration_s=1.2"]
SEARCH = {"key": "seed", "lowest": 0, "step": 1, "highest": 3, "confirm": 0}


@pytest.mark.parametrize(
    ("changes", "lines"),
    [
        (
            {"traces": [], "blocks": [{"factors": {"gait": ["stand", "gallop"]}, "overrides": STANDING}]},
            ["gait: unknown 'gallop'; known: "],
        ),
        (
            {"blocks": [{"factors": {"seed": [0, 1]}, "overrides": ["controlller=weighted"]}]},
            ["controlller: unknown key; did you mean 'controller'?; known: "],
        ),
        (
            {"blocks": [{"factors": {"seed": [0]}, "search": {**SEARCH, "key": "sceed"}}]},
            ["sceed: unknown key; did you mean 'seed'?; known: "],
        ),
        ({"job": "trail"}, ["job: unknown 'trail'; did you mean 'trial'?; known: "]),
        ({"job": "kinematic_cycles"}, ["planner: 'vertex_zmp' has no objectives; expected kinematic_sqp"]),
        ({"job": "table_one"}, ["job table_one: expected case=... and transcription=..., got "] * 2),
    ],
)
def test_wrong_configuration_is_refused_before_anything_runs(
    changes: dict[str, object], lines: list[str], study_folder: Path, tmp_path: Path
) -> None:
    (study_folder / "standing.yaml").write_text(yaml.safe_dump({**STUDY, **changes}))
    with pytest.raises(ConfigurationError) as refusal:
        run_studies(["standing"], tmp_path / "results", 1, StudyProgress(StringIO()))
    found = str(refusal.value).splitlines()
    assert len(found) == len(lines)
    assert all(shown.startswith(f"study/standing.yaml: {line}") for shown, line in zip(found, lines, strict=True))
    assert not (tmp_path / "results").exists()


def test_error_of_the_program_is_a_row_and_counted_and_no_limit(study_folder: Path, tmp_path: Path) -> None:
    """Here the folder of the trials cannot be made."""
    block = {"overrides": ["gait=stand", *STANDING], "factors": {"robot": ["anymal_b"]}, "search": SEARCH}
    (study_folder / "standing.yaml").write_text(yaml.safe_dump({**STUDY, "blocks": [block], "traces": []}))
    folder = tmp_path / "results" / "standing"
    folder.mkdir(parents=True)
    (folder / "trials").write_text("")
    assert run_studies(["standing"], tmp_path / "results", 1, StudyProgress(StringIO())) == 1
    assert list(pd.read_csv(folder / "table.csv")["status"]) == ["error"]
    limits = pd.read_csv(folder / "limits.csv")
    assert limits["limit"].isna().all()
    assert limits["unknown"][0].startswith("error at 1: NotADirectoryError: ")


def test_plan_that_fails_is_a_row_without_curves(study_folder: Path, tmp_path: Path) -> None:
    """The reason stays in the table and a second run does nothing."""
    block = {"overrides": ["gait=stand", "command.x_m=5", "duration_s=1.2"], "factors": {"seed": [0]}}
    (study_folder / "standing.yaml").write_text(yaml.safe_dump({**STUDY, "blocks": [block]}))
    assert "planning_failed" in _run(tmp_path / "results")
    table = pd.read_csv(tmp_path / "results" / "standing" / "table.csv")
    assert list(table["status"]) == ["planning_failed"]
    assert table["status_reason"][0].startswith("infeasible")
    assert _run(tmp_path / "results") == ""
