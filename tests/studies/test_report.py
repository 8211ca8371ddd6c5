"""The report tells of the robot what is known of it, and errors of the program apart."""

import pandas as pd

from quadlab.studies.config import StudyConfig
from quadlab.studies.report import study_report

STUDY = StudyConfig.model_validate(
    {
        "title": "Trots",
        "blocks": [{"factors": {"gait": ["trot"]}}],
        "report_by": ["gait"],
        "report_columns": ["mean_speed_mps"],
    }
)


def _lines(*statuses: str) -> list[str]:
    speeds = [0.1 * k for k in range(1, 1 + len(statuses))]
    table = pd.DataFrame({"gait": "trot", "status": list(statuses), "mean_speed_mps": speeds})
    return study_report(STUDY, table, pd.DataFrame()).splitlines()[2:]


def test_errors_are_no_falls() -> None:
    line = _lines(*["completed"] * 9, "error")[-1]
    assert line.startswith("| trot | 9 of 9 (70 to 100 %) |")
    assert line.endswith("| 1 error |")


def test_falls_and_errors_are_named() -> None:
    assert _lines("completed", "fell", "fell", "error")[-1].endswith("| 2 fell, 1 error |")
    assert "1 of 3" in _lines("completed", "fell", "fell", "error")[-1]


def test_group_of_errors_alone_says_that_nothing_is_known() -> None:
    assert _lines("error", "error")[-1] == "| trot | 0 of 0 (0 to 100 %) | - | 2 error |"


def test_largest_value_is_not_called_the_worst() -> None:
    """Of speeds it is the best."""
    head, _, line = _lines("completed", "completed", "fell")
    assert "| mean_speed_mps, median / max |" in head
    assert "| 0.15 / 0.2 |" in line
