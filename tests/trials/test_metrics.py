"""What a trial amounts to in numbers, computed again from its log."""

from pathlib import Path

import numpy as np
import pytest

from quadlab.analysis.log_reader import read_log
from quadlab.analysis.trial_log import vectors
from quadlab.constants import GRAVITY
from quadlab.robots.model import load_robot
from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions
from quadlab.trials.job import run_job
from quadlab.trials.progress import SilentProgress


@pytest.mark.parametrize(("payload_kg", "torque_scale"), [(0.0, 1.0), (5.0, 0.9)])
def test_cost_of_transport_is_that_of_the_simulated_robot(
    tmp_path: Path, payload_kg: float, torque_scale: float
) -> None:
    """Which carries what the controller does not know of, with drives that give less than is asked for."""
    error = f"simulation.model_error.payload_kg={payload_kg}", f"simulation.model_error.torque_scale={torque_scale}"
    config = compose_trial(["gait=trot", "duration_s=2.5", *error])
    outcome = run_job(config, RunOptions(force=False, results_dir=str(tmp_path)), SilentProgress())
    assert outcome.result is not None
    state = read_log(outcome.directory / "trial.mcap").state
    power = torque_scale * np.abs(vectors(state, "joint_torque") * vectors(state, "joint_velocity"))
    mass, distance = load_robot(config.robot).mass + payload_kg, outcome.result.distance_m
    assert distance is not None
    expected = power.sum() / config.controller.rate_hz / (mass * GRAVITY * distance)
    assert outcome.result.cost_of_transport == pytest.approx(expected, rel=1e-6)
