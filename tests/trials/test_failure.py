"""When a trial counts as failed: over, though its time is not up, or at its end and not where it was to go."""

from pathlib import Path

import numpy as np
import pytest
from tick_cases import HEIGHT_M, exact_telemetry, still_state, turned

from quadlab.trials.compose import compose_trial
from quadlab.trials.failure import FailureConfig, fall_reason, progress_reason
from quadlab.trials.progress import SilentProgress
from quadlab.trials.result import TrialStatus
from quadlab.trials.runner import run_trial

CONFIG = FailureConfig(height_share=0.5, tilt_rad=0.7, progress_share=0.5)


@pytest.mark.parametrize(
    ("yaw", "pitch", "roll", "degrees"),
    [
        (3.0, 0.0, 0.0, None),
        (1.0, 0.69, 0.0, None),
        (1.0, 0.71, 0.0, "41"),
        (-2.0, 0.0, -0.75, "43"),
        (0.0, 0.0, 3.1, "178"),
    ],
)
def test_base_that_is_tilted_too_far_has_fallen(yaw: float, pitch: float, roll: float, degrees: str | None) -> None:
    state = still_state(quat_wxyz=turned(yaw, pitch, roll))
    reason = None if degrees is None else f"fell at 0.00 s: base tilted by {degrees} deg"
    assert fall_reason(CONFIG, state, exact_telemetry(), HEIGHT_M) == reason


@pytest.mark.parametrize(
    ("base_m", "ground_m", "fallen"), [(0.26, 0.0, False), (0.24, 0.0, True), (0.24, -0.14, False), (0.6, 0.4, True)]
)
def test_base_that_is_low_over_the_ground_under_it_has_fallen(base_m: float, ground_m: float, fallen: bool) -> None:
    state = still_state(position_base_in_world=np.array([1.0, 0.0, base_m]))
    told = exact_telemetry(terrain_plane=np.array([ground_m, 0.0, 0.0]))
    reason = f"fell at 0.00 s: base {1e3 * (base_m - ground_m):.0f} mm over the ground" if fallen else None
    assert fall_reason(CONFIG, state, told, HEIGHT_M) == reason


@pytest.mark.parametrize(("distance_m", "planned_m", "stuck"), [(0.6, 1.0, False), (0.4, 1.0, True), (0.0, 0.0, False)])
def test_robot_that_comes_less_than_half_its_way_makes_no_progress(
    distance_m: float, planned_m: float, stuck: bool
) -> None:
    reason = progress_reason(CONFIG, distance_m, planned_m)
    assert reason == ("covered 0.40 m of 1.00 m planned" if stuck else None)


@pytest.mark.filterwarnings("ignore:Inertia matrix")
def test_physics_that_blows_up_is_a_status_and_leaves_no_file_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    push = ("scenario=push", "scenario.pushes.0.force_n=1e100", "scenario.pushes.0.start_s=0.5")
    trial = compose_trial(["gait=stand", "command=in_place", "duration_s=1", *push])
    result = run_trial(trial, tmp_path, SilentProgress())
    assert result.status is TrialStatus.DIVERGED
    assert result.status_reason.startswith("the state is not finite at 0.5")
    assert result.survived_s == pytest.approx(0.5, abs=0.01)
    assert [path.name for path in tmp_path.iterdir()] == ["trial.mcap"]
