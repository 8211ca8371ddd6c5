"""Sweeps of very short trials."""

import json
from pathlib import Path

from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.trial_pool import SweepTrial, run_trials
from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions
from quadlab.trials.job import JobOutcome

STANDING = (
    "gait=stand",
    "gait.cycles.0.stride_duration_s=0.2",
    "command=in_place",
    "scenario=perturbed",
    "duration_s=0.2",
)
FREE = PoolConfig(workers=2, memory_limit_gib=None, time_limit_s=None)


def standing(count: int, *overrides: str) -> list[SweepTrial]:
    """Return trials that stand for a moment, from different starts."""
    return [SweepTrial(f"seed={s}", compose_trial([*STANDING, f"seed={s}", *overrides])) for s in range(count)]


def run(trials: list[SweepTrial], folder: Path, pool: PoolConfig = FREE) -> dict[str, JobOutcome]:
    """Run trials into ``folder`` and return their outcomes by name."""
    options = RunOptions(force=False, results_dir=str(folder))
    return {outcome.trial.name: outcome.job for outcome in run_trials(trials, options, pool)}


def state_hashes(folder: Path) -> dict[str, str]:
    """Return the hash of the motion of every finished trial below ``folder``, by its id."""
    return {path.parent.name: json.loads(path.read_text())["state_sha256"] for path in folder.rglob("result.json")}
