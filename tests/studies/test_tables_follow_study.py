"""Tables and report tell what the study's file and its rows say now, also where no job had to be run."""

import json
import subprocess
import sys
from collections.abc import Callable
from io import StringIO
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
import yaml

from quadlab.studies import config as study_config
from quadlab.studies import runner
from quadlab.studies.files import configuration_hash, write_row
from quadlab.studies.open_study import open_study
from quadlab.studies.progress import StudyProgress
from quadlab.studies.runner import run_studies

SEARCH = {"key": "f", "lowest": 1, "step": 1, "highest": 1, "confirm": 0}
STUDY: dict[str, Any] = {
    "title": "Pushes",
    "job": "done before",  # by hand, below: no job runs in these tests
    "blocks": [{"factors": {"variant": {"with": ["a=1"], "without": ["a=0"]}}, "search": SEARCH}],
    "report_by": ["variant"],
}
Run = Callable[..., str]


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """A function that runs a study with some changes, all jobs of which were done before, and returns the report."""
    monkeypatch.setattr(study_config, "CONF_DIR", tmp_path)
    (tmp_path / "study").mkdir()

    def run(speed: float = 1.0, configuration: str = configuration_hash(), **changes: object) -> str:
        (tmp_path / "study" / "x.yaml").write_text(yaml.safe_dump({**STUDY, **changes}))
        monkeypatch.setattr(runner, "configuration_hash", lambda: configuration)
        _remember(tmp_path, configuration, speed)
        output = StringIO()
        assert run_studies(["x"], tmp_path, 1, StudyProgress(output)) == 0
        assert output.getvalue() == ""
        return (tmp_path / "x" / "report.md").read_text()

    return run


def _remember(results: Path, configuration: str, speed: float) -> None:
    opened = open_study("x", results, configuration)
    for condition in opened.conditions:
        job = condition.next_job()
        assert job is not None
        write_row(opened.folder, job.identifier, opened.work(job).settings, {"status": "completed", "speed": speed})


def _files(folder: Path) -> dict[str, int]:
    return {path.name: path.stat().st_mtime_ns for path in folder.glob("*.*")}


def test_second_run_writes_nothing(run: Run, tmp_path: Path) -> None:
    run()
    before = _files(tmp_path / "x")
    run()
    assert _files(tmp_path / "x") == before
    assert set(before) == {"table.csv", "limits.csv", "manifest.json", "report.md"}


def test_title_and_columns_of_the_report_follow_the_file(run: Run) -> None:
    assert run().startswith("# Pushes\n")
    report = run(title="Shoves", report_columns=["speed"])
    assert report.startswith("# Shoves\n")
    assert "speed" in report


def test_level_that_was_renamed_or_removed_is_not_told_any_more(run: Run, tmp_path: Path) -> None:
    run()
    run(blocks=[{"factors": {"variant": {"aligned": ["a=1"], "without": ["a=0"]}}, "search": SEARCH}])
    assert list(pd.read_csv(tmp_path / "x" / "table.csv")["variant"]) == ["aligned", "without"]
    assert "| without |" not in run(blocks=[{"factors": {"variant": {"aligned": ["a=1"]}}, "search": SEARCH}])
    assert list(pd.read_csv(tmp_path / "x" / "limits.csv")["variant"]) == ["aligned"]


def test_study_that_searches_for_nothing_any_more_has_no_limits(run: Run, tmp_path: Path) -> None:
    run()
    assert (tmp_path / "x" / "limits.csv").is_file()
    run(blocks=[{"factors": {"variant": {"with": ["a=1"]}}}])
    assert not (tmp_path / "x" / "limits.csv").exists()


def test_rows_of_a_run_that_was_interrupted_before_its_tables_are_told_by_the_next(run: Run, tmp_path: Path) -> None:
    run()
    run(speed=2.0)
    assert list(pd.read_csv(tmp_path / "x" / "table.csv")["speed"]) == [2.0, 2.0]


@pytest.mark.parametrize("name", ["table.csv", "limits.csv", "report.md", "manifest.json"])
def test_file_that_was_removed_is_written_again(name: str, run: Run, tmp_path: Path) -> None:
    run()
    (tmp_path / "x" / name).unlink()
    run()
    assert (tmp_path / "x" / name).is_file()


@pytest.mark.parametrize("content", [b"{", b"\xff", b"[]", b"{}"])
def test_damaged_manifest_is_written_again(content: bytes, run: Run, tmp_path: Path) -> None:
    run()
    (tmp_path / "x" / "manifest.json").write_bytes(content)
    run()
    assert json.loads((tmp_path / "x" / "manifest.json").read_text())["jobs"] == 2


def test_manifest_has_the_configuration_under_which_the_rows_hold(run: Run, tmp_path: Path) -> None:
    run()
    run(configuration="another")
    assert json.loads((tmp_path / "x" / "manifest.json").read_text())["configuration_sha256"] == "another"


def test_asking_whether_something_is_left_imports_nothing_heavy(run: Run, tmp_path: Path) -> None:
    run()
    code = f"""import sys
from pathlib import Path
from quadlab.studies import config
config.CONF_DIR = Path({str(tmp_path)!r})
from quadlab.studies.main import main
code = main(["x", "--results", {str(tmp_path)!r}])
print(code, *({{"pandas", "hydra", "mujoco", "pinocchio", "scipy"}} & set(sys.modules)))"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "0"
