"""Studies run what is missing and nothing else; what fails is a row."""

from collections.abc import Iterator
from io import StringIO
from pathlib import Path

import pandas as pd
import pytest
import yaml

from quadlab.analysis.study_results import StudyResults
from quadlab.errors import LogError
from quadlab.studies import config as study_config
from quadlab.studies import files
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
def study_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of studies with one in it; only the search for studies looks there."""
    folder = tmp_path / "conf" / "study"
    folder.mkdir(parents=True)
    (folder / "standing.yaml").write_text(yaml.safe_dump(STUDY))
    monkeypatch.setattr(study_config, "CONF_DIR", tmp_path / "conf")
    files.configuration_hash.cache_clear()
    yield folder
    files.configuration_hash.cache_clear()


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


def test_wrong_configuration_is_a_row_and_counted(study_folder: Path, tmp_path: Path) -> None:
    wrong = {
        **STUDY,
        "traces": [],
        "blocks": [{"factors": {"gait": ["stand", "gallop"]}, "overrides": ["command=in_place", "duration_s=1.2"]}],
    }
    (study_folder / "standing.yaml").write_text(yaml.safe_dump(wrong))
    assert run_studies(["standing"], tmp_path / "results", 1, StudyProgress(StringIO())) == 1
    table = pd.read_csv(tmp_path / "results" / "standing" / "table.csv")
    assert list(table["status"]) == ["completed", "error"]
    assert "gallop" in table["status_reason"][1]


def test_plan_that_fails_is_a_row_without_curves(study_folder: Path, tmp_path: Path) -> None:
    """The reason stays in the table and a second run does nothing."""
    block = {"overrides": ["gait=stand", "command.x_m=5", "duration_s=1.2"], "factors": {"seed": [0]}}
    (study_folder / "standing.yaml").write_text(yaml.safe_dump({**STUDY, "blocks": [block]}))
    assert "planning_failed" in _run(tmp_path / "results")
    table = pd.read_csv(tmp_path / "results" / "standing" / "table.csv")
    assert list(table["status"]) == ["planning_failed"]
    assert table["status_reason"][0].startswith("infeasible")
    assert _run(tmp_path / "results") == ""
