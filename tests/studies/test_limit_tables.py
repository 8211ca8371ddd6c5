"""Limits in tables and reports: what was found, what could not be, and how sure it is."""

from pathlib import Path

import pandas as pd
import pytest

from paper_figures.known_limits import known_limits
from quadlab.analysis.study_results import StudyResults
from quadlab.errors import LogError
from quadlab.studies.boundary import BoundarySearch
from quadlab.studies.condition import Condition
from quadlab.studies.config import SearchConfig, StudyConfig
from quadlab.studies.open_study import OpenCondition
from quadlab.studies.report import study_report
from quadlab.studies.tables import limit_table

KILLED = {"status": "error", "status_reason": "killed by signal 9"}
TABLE = pd.DataFrame({"gait": ["walk"], "status": ["fell"]})


def _study(search: SearchConfig) -> StudyConfig:
    block = {"factors": {"gait": ["walk"]}, "search": search.model_dump()}
    return StudyConfig.model_validate({"title": "Pushes", "blocks": [block], "report_by": ["gait"]})


def _searched(largest: float, killed_at: float | None = None, **grid: float) -> tuple[Condition, BoundarySearch]:
    """Search with trials that survive up to ``largest``, one of which may be killed."""
    config = SearchConfig.model_validate({"key": "f", "lowest": 0, "step": 10, "highest": 100, "confirm": 0, **grid})
    search = BoundarySearch(config)
    opened = OpenCondition(Condition({"gait": "walk"}, ("gait=walk",), config), search)
    while (job := opened.next_job()) is not None:
        value = float(job.levels["f"])
        opened.take(job, KILLED if value == killed_at else {"status": "completed" if value <= largest else "fell"})
    return opened.condition, search


def _report(*searches: tuple[Condition, BoundarySearch]) -> str:
    return study_report(_study(searches[0][1].config), TABLE, limit_table(searches)).splitlines()[-1]


def test_trial_that_was_killed_leaves_the_limit_unknown_and_says_why() -> None:
    table = limit_table([_searched(80.0, killed_at=50.0), _searched(80.0)])
    assert table["limit"].isna().tolist() == [True, False]
    assert table["limit"][1] == 80.0
    assert table["unknown"][0] == "error at 50: killed by signal 9"
    assert pd.isna(table["unknown"][1])


def test_table_without_errors_has_the_columns_that_it_always_had() -> None:
    table = limit_table([_searched(80.0)])
    assert list(table) == ["gait", "key", "limit", "highest", "step", "probes", "monotone"]


def test_limits_that_are_unknown_are_no_zeros_in_the_report() -> None:
    assert _report(_searched(80.0)) == "| walk | f | 1 | 80 | 80 | 80 | 0 | - |"
    assert _report(_searched(80.0, 50.0), _searched(80.0)) == "| walk | f | 2 | 1 | 80 | 80 | 80 | 0 | - |"
    assert _report(_searched(80.0, 50.0)) == "| walk | f | 1 | 1 | - | - | - | - | - |"


def test_what_survives_the_last_value_of_the_grid_is_above_it() -> None:
    """Its last value may be below ``highest``."""
    row = _searched(1000.0, lowest=40, step=50, highest=100)
    assert limit_table([row])["highest"][0] == 90.0
    assert _report(row) == "| walk | f | 1 | 90 | 90 | 90 | 1 | - |"


def test_report_says_of_how_many_searches_values_below_the_limit_were_tried() -> None:
    odd = _searched(80.0, confirm=2)
    odd[1].record(70.0, survived=False)
    assert _report(_searched(80.0, confirm=1), odd, _searched(80.0)).endswith("| 0 | 1 of 2 |")


def test_figures_refuse_tables_of_an_earlier_form_of_the_study(tmp_path: Path) -> None:
    (tmp_path / "ablations").mkdir()
    for name in ("limits.csv", "table.csv"):
        limit_table([_searched(80.0)]).to_csv(tmp_path / "ablations" / name, index=False)
    results = StudyResults(tmp_path)
    line = r"^ablations/{}\.csv: no column 'disturbance', .*; python experiments/run_study.py ablations makes it anew$"
    with pytest.raises(LogError, match=line.format("limits")):
        known_limits(results, "ablations", ["gait", "disturbance"])
    with pytest.raises(LogError, match=line.format("table")):
        results.table("ablations", ["gait", "disturbance"])
    assert len(known_limits(results, "ablations", ["gait"])) == len(results.table("ablations", ["gait"])) == 1


def test_figures_refuse_limits_that_are_unknown(monkeypatch: pytest.MonkeyPatch) -> None:
    table = limit_table([_searched(80.0, killed_at=50.0), _searched(80.0)])
    monkeypatch.setattr(StudyResults, "limits", lambda *_: table)
    with pytest.raises(LogError, match=r"ablations/limits.csv: 1 of 2 limits are unknown since trials ended in an err"):
        known_limits(StudyResults(folder=pd.NA), "ablations")  # type: ignore[arg-type]
    monkeypatch.setattr(StudyResults, "limits", lambda *_: table.drop(columns="unknown"))
    assert len(known_limits(StudyResults(folder=pd.NA), "ablations")) == 2  # type: ignore[arg-type]
