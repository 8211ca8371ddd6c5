"""A trial's id depends on what happens in the trial, and on nothing else."""

import json
import os
import subprocess
import sys

import pytest

from quadlab.trials.compose import compose_trial
from quadlab.trials.config import TrialConfig
from quadlab.trials.identity import canonical_json, trial_id


def test_id_is_16_hexadecimal_digits() -> None:
    assert len(trial_id(compose_trial())) == 16
    int(trial_id(compose_trial()), 16)


@pytest.mark.parametrize("override", ["tag=elsewhere", "log.scene_rate_hz=10", "force=true", "results_dir=there"])
def test_id_does_not_depend_on_where_results_go_and_what_is_logged(override: str) -> None:
    assert trial_id(compose_trial([override])) == trial_id(compose_trial())


CHANGES = {
    "robot": "robot.foot_radius_m=0.03",
    "gait": "gait.initial_stance_s=0.7",
    "command": "command.x_m=0.3",
    "planner": "planner.robustness_weight=2",
    "controller": "controller.tracking.swing.apex=0.3",
    "estimator": "estimator=ekf",
    "scenario": "scenario.friction=0.6",
    "simulation": "simulation.model_error.payload_kg=1",
    "replanning": "replanning.period_s=0.2",
    "failure": "failure.tilt_rad=0.6",
    "duration_s": "duration_s=10.1",
    "seed": "seed=1",
}


@pytest.mark.parametrize("override", CHANGES.values())
def test_id_depends_on_everything_else(override: str) -> None:
    assert trial_id(compose_trial([override])) != trial_id(compose_trial())


def test_every_part_of_a_trial_is_tried() -> None:
    assert set(CHANGES) == set(TrialConfig.model_fields) - {"tag", "log"}


def test_spelling_of_a_number_does_not_matter() -> None:
    spellings = ["duration_s=50", "duration_s=50.0", "duration_s=5e1", "duration_s='50'"]
    assert len({trial_id(compose_trial([spelling])) for spelling in spellings}) == 1


def test_id_is_the_same_in_another_process_with_another_hash_seed() -> None:
    code = (
        "from quadlab.trials.compose import compose_trial; from quadlab.trials.identity import trial_id; "
        "print(trial_id(compose_trial(['gait=walk'])))"
    )
    command, environment = [sys.executable, "-c", code], {**os.environ, "PYTHONHASHSEED": "5"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == trial_id(compose_trial(["gait=walk"]))


def test_canonical_json_holds_the_parts_with_all_their_fields() -> None:
    config = compose_trial()
    values = json.loads(canonical_json(config))
    assert values["planner"]["kind"] == "vertex_zmp"
    assert values["controller"]["rate_hz"] == config.controller.rate_hz
    assert values["controller"]["levels"]
    assert "tag" not in values
