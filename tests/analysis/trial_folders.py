"""Folders of trials that were never run: the files that trials leave, with made-up numbers."""

import json
from functools import cache
from pathlib import Path

import yaml

from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions, TrialConfig
from quadlab.trials.identity import trial_id
from quadlab.trials.job import record_failure, trial_directory
from quadlab.trials.result import TrialResult, TrialStatus, write_result

COMMIT = "c" * 40


def options(results: Path) -> RunOptions:
    return RunOptions(force=False, results_dir=str(results))


@cache
def _composed(overrides: tuple[str, ...]) -> TrialConfig:
    return compose_trial(overrides)


def begin(results: Path, *overrides: str, commit: str = COMMIT) -> tuple[Path, TrialConfig]:
    """Leave what a trial leaves that was killed on the way."""
    config = _composed(overrides)
    directory = trial_directory(config, options(results))
    directory.mkdir(parents=True)
    (directory / "config.yaml").write_text(yaml.safe_dump(config.model_dump(mode="json")))
    (directory / "manifest.json").write_text(json.dumps({"git": {"commit": commit}}))
    (directory / "trial.mcap.part").write_bytes(b"half")
    return directory, config


def finish(
    results: Path,
    *overrides: str,
    status: TrialStatus = TrialStatus.COMPLETED,
    com_error_rms_mm: float | None = 2.0,
    commit: str = COMMIT,
) -> Path:
    """Leave what a finished trial leaves."""
    directory, config = begin(results, *overrides, commit=commit)
    (directory / "trial.mcap.part").rename(directory / "trial.mcap")
    result = TrialResult(
        trial_id=trial_id(config),
        status=status,
        status_reason="why",
        robot=config.robot.name,
        gait=config.gait.name,
        planner=config.planner.name,
        controller=config.controller.name,
        estimator=config.estimator.kind,
        scenario=config.scenario.name,
        seed=config.seed,
        duration_s=config.duration_s,
        com_error_rms_mm=com_error_rms_mm,
    )
    write_result(directory, result)
    return directory


def fail(results: Path, *overrides: str) -> Path:
    """Leave what a trial leaves whose process was killed in a sweep."""
    directory, config = begin(results, *overrides)
    record_failure(config, options(results), "died", "killed by SIGKILL", "")
    return directory
