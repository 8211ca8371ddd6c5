"""Costs of the kinematic planner as a row of a study."""

from pathlib import Path

import pytest

from quadlab.errors import ConfigurationError
from quadlab.studies.jobs_kinematic import kinematic_cycles_row
from quadlab.trials.composer import Composer

TROT = ("gait=trot", "gait.initial_stance_s=0", "gait.final_stance_s=0", "duration_s=1.6", "command.x_m=0.15")


def test_costs_add_up_and_fall(tmp_path: Path) -> None:
    row = kinematic_cycles_row(["planner=kinematic_sqp", *TROT], tmp_path, Composer())
    parts = sum(value for name, value in row.items() if name.startswith("cost_"))
    assert row["total"] == pytest.approx(parts)
    assert row["total"] == row[f"total_{row['iterations']}"]
    assert row["total"] < 0.5 * row["total_1"]


def test_another_planner_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="vertex_zmp"):
        kinematic_cycles_row(["planner=vertex_zmp", *TROT], tmp_path, Composer())
