"""Plans of Winkler 2017, Table I, as rows of a study."""

from pathlib import Path

import pytest

from quadlab.errors import ConfigurationError
from quadlab.planners.plan_io import load_plan
from quadlab.studies.jobs_table_one import table_one_row
from quadlab.trials.composer import Composer
from quadlab.trials.plan_job import PLAN_FILE


def test_row_tells_the_size_of_the_program_and_keeps_the_plan(tmp_path: Path) -> None:
    row = table_one_row(["case=trot 4", "transcription=fast"], tmp_path, Composer())
    assert row["status"] == "solved"
    plan = load_plan(tmp_path / row["directory"] / PLAN_FILE)
    assert plan.report.variables == row["variables"]
    assert plan.com(plan.duration_s)[0] == pytest.approx(0.2, abs=1e-6)


def test_biped_has_feet_that_turn(tmp_path: Path) -> None:
    row = table_one_row(["case=biped", "transcription=paper"], tmp_path, Composer())
    assert row["status"] == "solved"
    assert len(load_plan(tmp_path / row["directory"] / PLAN_FILE).foot_yaws) == 2


def test_unknown_case_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="unknown 'trott 4'; did you mean 'trot 4'"):
        table_one_row(["case=trott 4", "transcription=fast"], tmp_path, Composer())


def test_missing_option_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=r"expected case=... and transcription=..., got \['case=trot 4'\]"):
        table_one_row(["case=trot 4"], tmp_path, Composer())
