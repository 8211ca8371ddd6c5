"""The same sweep on a cluster: the same results, a dead task loses nothing but its own trials."""

import json
import os
import shlex
import sys
from pathlib import Path

import fake_slurm
import pytest
from sweep_cases import STANDING, state_hashes

from quadlab.sweeps import slurm as slurm_module
from quadlab.sweeps.main import main

SWEEP = ["-m", *STANDING, "seed=0,1,2", "launcher=slurm", "slurm.trials_per_task=2", "slurm.partition=short"]


@pytest.fixture
def cluster(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Put a cluster on the PATH and work in an empty folder; return where the cluster keeps its state."""
    state, binaries = tmp_path / "cluster", tmp_path / "bin"
    state.mkdir()
    binaries.mkdir()
    for command in ("sbatch", "srun", "sacct", "scancel"):
        program = binaries / command
        program.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} {fake_slurm.__file__} {command} "$@"\n')
        program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{binaries}:{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(path for path in sys.path if path))
    monkeypatch.setenv("FAKE_SLURM", str(state))
    monkeypatch.setattr(slurm_module, "POLL_S", 0.1)
    monkeypatch.setattr(slurm_module, "QUEUE_POLL_S", 1.0)
    monkeypatch.chdir(tmp_path)
    return state


def test_sweep_on_slurm_gives_what_the_pool_gives(cluster: Path, tmp_path: Path) -> None:
    assert main([*SWEEP, "results_dir=there"]) == 0
    assert main(["-m", *STANDING, "seed=0,1,2", "results_dir=here"]) == 0
    assert len(state_hashes(tmp_path / "here")) == 3
    assert state_hashes(tmp_path / "there") == state_hashes(tmp_path / "here")
    script = (cluster / "script.sh").read_text()
    assert "#SBATCH --array=0-1%2" in script
    assert "#SBATCH --partition=short" in script


def test_dead_task_is_reported_and_the_next_sweep_runs_only_its_trials(
    cluster: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("FAKE_SLURM_KILL", "1")
    assert main(SWEEP) == 1
    assert "SLURM task 1000_1 ended without an answer: FAILED" in capsys.readouterr().err
    assert len(state_hashes(tmp_path / "results")) == 2
    (error,) = (tmp_path / "results").rglob("error.json")
    assert json.loads(error.read_text())["type"] == "died"
    monkeypatch.delenv("FAKE_SLURM_KILL")
    assert main(SWEEP) == 0
    assert "--array" not in (cluster / "script.sh").read_text()
    assert len(state_hashes(tmp_path / "results")) == 3


def test_without_slurm_the_sweep_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(SWEEP) == 1
    assert "quadlab: SLURM took no job: Could not detect" in capsys.readouterr().err
