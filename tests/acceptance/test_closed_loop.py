"""Closed-loop trials in a small version; ``make acceptance`` runs the gaits in full."""

import subprocess
import sys
from pathlib import Path

import pytest

from quadlab.analysis.log_reader import read_log
from quadlab.robots.catalogue import robot_names
from quadlab.trials.compose import compose_trial
from quadlab.trials.progress import SilentProgress
from quadlab.trials.recording.topics import LOG_FILE
from quadlab.trials.result import TrialResult, TrialStatus
from quadlab.trials.runner import run_trial

REPEATED = "from quadlab.trials.main import main; raise SystemExit(main())"


def run(directory: Path, *overrides: str) -> TrialResult:
    return run_trial(compose_trial(overrides), directory, SilentProgress())


@pytest.mark.parametrize("robot", robot_names())
def test_every_robot_stands_still(robot: str, tmp_path: Path) -> None:
    result = run(tmp_path, f"robot={robot}", "gait=stand", "command=in_place", "duration_s=5")
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    assert result.distance_m is not None and result.distance_m < 1e-3
    assert result.base_height_rms_mm is not None and result.base_height_rms_mm < 1.0
    assert result.control_fallbacks == 0


@pytest.mark.parametrize("robot", robot_names())
def test_every_robot_trots(robot: str, tmp_path: Path) -> None:
    result = run(tmp_path, f"robot={robot}", "gait=trot", "command.x_m=0.1", "duration_s=3.6")
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    assert result.com_error_max_mm is not None and result.com_error_max_mm < 15.0


@pytest.mark.parametrize("gait", ["walk", "trot"])
@pytest.mark.parametrize("robot", ["anymal_b", "hyq"])
def test_gait_from_a_perturbed_start(robot: str, gait: str, tmp_path: Path) -> None:
    duration_s = {"walk": 7.0, "trot": 5.0}[gait]
    result = run(tmp_path, f"robot={robot}", f"gait={gait}", "scenario=perturbed", "seed=3", f"duration_s={duration_s}")
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    assert result.com_error_max_mm is not None and result.com_error_max_mm < 30.0
    assert result.roll_pitch_rms_deg is not None and result.roll_pitch_rms_deg < 0.7
    assert result.torque_max_nm is not None and result.torque_max_nm <= {"anymal_b": 40.0, "hyq": 150.0}[robot]
    assert result.limit_residual_max is not None and result.limit_residual_max < 1e-6, "torque, friction, unilateral"
    assert result.control_fallbacks == 0


@pytest.mark.parametrize("command", ["turn", "sideways"])
def test_trot_goes_where_it_is_told(command: str, tmp_path: Path) -> None:
    result = run(tmp_path, f"command={command}", "duration_s=5")
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    assert result.com_error_max_mm is not None and result.com_error_max_mm < 15.0


def test_trot_over_an_unseen_plank_and_through_a_push(tmp_path: Path) -> None:
    result = run(tmp_path, "scenario=plank_and_push", "duration_s=10.2")
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    assert result.base_height_rms_mm is not None and result.base_height_rms_mm > 1.0, "the plank was not felt"
    assert result.com_error_max_mm is not None and result.com_error_max_mm > 20.0, "the push was not felt"


@pytest.mark.parametrize("center_x_m", [0.59, 0.71])
def test_trot_over_an_unseen_plank_as_high_as_most_of_a_swing(center_x_m: float, tmp_path: Path) -> None:
    """Feet come down early on the plank and late behind it; the plan's next pair waits for them."""
    plank = ("scenario.terrain.0.height_m=0.10", f"scenario.terrain.0.center_x_m={center_x_m}")
    result = run(tmp_path, "experiment=gehring2017_trot_plank", *plank)
    assert result.status is TrialStatus.COMPLETED, result.status_reason


@pytest.mark.parametrize("direction", ["[-1,0,0]", "[0,1,0]"])
def test_trot_with_the_priorities_of_gehring_2017_survives_a_push(direction: str, tmp_path: Path) -> None:
    """The drives hold the legs in the air against what the base, which stands above them, asks of these."""
    push = ("start_s=1.8", "force_n=100", f"direction={direction}")
    overrides = (f"scenario.pushes.0.{item}" for item in push)
    result = run(tmp_path, "controller=gehring2017", "scenario=push", "duration_s=4", *overrides)
    assert result.status is TrialStatus.COMPLETED, result.status_reason


def test_too_large_a_push_is_a_fall_and_no_exception(tmp_path: Path) -> None:
    result = run(tmp_path, "scenario=push", "scenario.pushes.0.force_n=2000", "scenario.pushes.0.start_s=1.0")
    assert result.status is TrialStatus.FELL
    assert "fell at" in result.status_reason
    assert result.survived_s is not None and 1.0 < result.survived_s < result.duration_s


def test_unreachable_goal_is_a_status(tmp_path: Path) -> None:
    result = run(tmp_path, "command=goal", "command.x_m=100", "duration_s=3")
    assert result.status is TrialStatus.PLANNING_FAILED
    assert "100 m" in result.status_reason
    assert result.survived_s is None


def test_two_processes_give_the_same_trial(tmp_path: Path) -> None:
    hashes = []
    for name in ("first", "second"):
        overrides = ["gait=trot", "scenario=perturbed", "seed=5", "duration_s=2.5", f"results_dir={tmp_path / name}"]
        subprocess.run([sys.executable, "-c", REPEATED, *overrides], check=True, capture_output=True)
        (path,) = (tmp_path / name).rglob("result.json")
        hashes.append(TrialResult.model_validate_json(path.read_text()).state_sha256)
    assert hashes[0] is not None
    assert hashes[0] == hashes[1]


@pytest.mark.parametrize(("reference", "moves_mm"), [("com", 0.0), ("base", 2.0)])
def test_base_that_is_planned_is_followed_if_asked_for(reference: str, moves_mm: float, tmp_path: Path) -> None:
    """The kinematic planner raises and lowers the base, a pendulum does not."""
    torso = f"controller.tracking.torso.reference={reference}"
    result = run(tmp_path, "gait=trot", "planner=kinematic_sqp", "command.x_m=0.1", "duration_s=3.6", torso)
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    assert result.base_height_rms_mm is not None and result.base_height_rms_mm < 3.0
    heights = read_log(tmp_path / LOG_FILE).control["base_height_reference"]
    assert 1e3 * (heights.max() - heights.min()) >= moves_mm
