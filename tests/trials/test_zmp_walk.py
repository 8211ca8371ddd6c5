"""The walk of Bellicoso 2016, Fig. 4: planned with splines, tracked by the paper's priorities."""

from pathlib import Path

import pytest

from quadlab.trials.compose import compose_trial
from quadlab.trials.progress import SilentProgress
from quadlab.trials.result import TrialStatus
from quadlab.trials.runner import run_trial

PAPER_ERROR_MM = 3.4


@pytest.mark.parametrize("robot", ["anymal_b", "hyq"])
def test_com_follows_the_zmp_walk_as_closely_as_in_the_paper(robot: str, tmp_path: Path) -> None:
    overrides = [f"robot={robot}", "gait=walk", "planner=zmp_spline", "controller=bellicoso2016", "duration_s=7"]
    result = run_trial(compose_trial(overrides), tmp_path, SilentProgress())
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    assert result.com_error_max_mm is not None and result.com_error_max_mm < PAPER_ERROR_MM
    assert result.control_fallbacks == 0
