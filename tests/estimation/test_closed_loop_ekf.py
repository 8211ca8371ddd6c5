"""The controller lives on the estimate: robots stay up, the log holds estimate and truth, seeds repeat."""

from pathlib import Path

import numpy as np
import pytest

from quadlab.analysis.log_reader import read_log
from quadlab.analysis.trial_log import vectors
from quadlab.trials.compose import compose_trial
from quadlab.trials.progress import SilentProgress
from quadlab.trials.recording.topics import LOG_FILE
from quadlab.trials.result import TrialResult, TrialStatus
from quadlab.trials.runner import run_trial


def run(directory: Path, *overrides: str) -> TrialResult:
    directory.mkdir(exist_ok=True)
    return run_trial(compose_trial(["estimator=ekf", *overrides]), directory, SilentProgress())


def value(number: float | None) -> float:
    assert number is not None
    return number


@pytest.fixture(scope="module")
def long_trot(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, TrialResult]:
    directory = tmp_path_factory.mktemp("ekf")
    return directory, run(directory, "gait=trot", "duration_s=10")


def test_trot_of_ten_seconds(long_trot: tuple[Path, TrialResult]) -> None:
    _, result = long_trot
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    assert value(result.com_error_believed_max_mm) < 15.0
    assert value(result.com_error_max_mm) < 30.0
    assert value(result.estimate_velocity_rms_mps) < 0.015
    assert value(result.estimate_roll_pitch_rms_deg) < 0.5
    assert value(result.estimate_position_drift_mm) < 50.0
    assert result.control_fallbacks == 0


def test_log_holds_estimate_beside_truth(long_trot: tuple[Path, TrialResult]) -> None:
    directory, result = long_trot
    log = read_log(directory / LOG_FILE)
    assert len(log.estimate) == len(log.state)
    drift = vectors(log.estimate, "base_position") - vectors(log.state, "base_position")
    assert 1e3 * np.linalg.norm(drift[-1]) == pytest.approx(value(result.estimate_position_drift_mm))
    assert set(log.estimate["contact_LF"].unique()) == {0, 1}
    assert log.estimate["innovation_size"].max() == 12
    assert vectors(log.estimate, "gyro_bias").shape == (len(log.state), 3)


def test_height_that_is_believed_is_the_one_over_the_ground(long_trot: tuple[Path, TrialResult]) -> None:
    """On level ground the true height says the same; the height in the world drifts."""
    directory, result = long_trot
    height = read_log(directory / LOG_FILE).state["base_position_z"]
    over_ground_mm = 1e3 * float(np.sqrt(np.mean((height - height.iloc[0]) ** 2)))
    assert value(result.base_height_believed_rms_mm) == pytest.approx(over_ground_mm, abs=0.5)


def test_log_of_the_truth_has_no_estimate(tmp_path: Path) -> None:
    result = run_trial(compose_trial(["gait=stand", "command=in_place", "duration_s=1"]), tmp_path, SilentProgress())
    assert read_log(tmp_path / LOG_FILE).estimate.empty
    assert result.estimate_position_drift_mm is None


@pytest.mark.parametrize(
    "overrides",
    [
        ("robot=hyq", "gait=trot", "duration_s=3", "scenario=perturbed", "seed=3"),
        ("gait=trot", "duration_s=3", "estimator.contact_sensing=torques", "estimator.sensors.latency_ticks=1"),
    ],
    ids=" ".join,
)
def test_robots_gaits_and_contact_sensing(overrides: tuple[str, ...], tmp_path: Path) -> None:
    result = run(tmp_path, *overrides)
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    assert value(result.estimate_roll_pitch_rms_deg) < 1.0
    assert value(result.com_error_believed_max_mm) < 40.0


def test_plank_and_push(tmp_path: Path) -> None:
    result = run(tmp_path, "scenario=plank_and_push", "duration_s=10.2", "seed=1")
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    assert value(result.com_error_max_mm) > 20.0, "the push was not felt"


def test_seed_decides_the_trial(tmp_path: Path) -> None:
    def hash_of(name: str, seed: int) -> str | None:
        return run(tmp_path / name, "gait=trot", "duration_s=2", f"seed={seed}").state_sha256

    first, again, other = hash_of("first", 1), hash_of("again", 1), hash_of("other", 2)
    assert first == again != other
