"""The same sweep on a cluster: the same results, a dead task loses nothing but its own trials."""

import io
import json
import os
import shlex
import signal
import sys
from pathlib import Path
from typing import Any

import fake_slurm
import pytest
import submitit
from sweep_cases import STANDING, standing, state_hashes

from quadlab.sweeps import slurm as slurm_module
from quadlab.sweeps import slurm_queue as queue_module
from quadlab.sweeps.interrupts import interrupts_later
from quadlab.sweeps.main import main
from quadlab.sweeps.slurm_queue import QueueWatch
from quadlab.sweeps.terminal import PlainSweep
from quadlab.trials.config import RunOptions
from quadlab.trials.job import trial_directory

SWEEP = ["-m", *STANDING, "seed=0,1,2", "launcher=slurm", "slurm.trials_per_task=2", "slurm.partition=short"]


@pytest.fixture
def cluster(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Put a cluster on the PATH and work in an empty folder; return where the cluster keeps its state."""
    state, binaries = tmp_path / "cluster", tmp_path / "bin"
    state.mkdir()
    binaries.mkdir()
    for command in ("sbatch", "srun", "sacct", "squeue", "scancel"):
        program = binaries / command
        program.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} {fake_slurm.__file__} {command} "$@"\n')
        program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{binaries}:{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(path for path in sys.path if path))
    monkeypatch.setenv("FAKE_SLURM", str(state))
    monkeypatch.setattr(slurm_module, "POLL_S", 0.1)
    monkeypatch.setattr(slurm_module, "QUEUE_POLL_S", 1.0)
    monkeypatch.setattr(submitit.SlurmJob, "_results_timeout_s", 1)
    submitit.SlurmJob.watcher.clear()  # the cluster numbers its jobs anew
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


def test_forced_task_that_dies_has_no_old_results(
    cluster: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("FAKE_SLURM_KILL", "1")
    trials = [trial.config for trial in standing(3)]
    old = [trial_directory(config, RunOptions(force=True, results_dir="results")) for config in trials]
    for directory in old:
        directory.mkdir(parents=True)
        (directory / "result.json").write_text("{}")
    assert main([*SWEEP, "force=true"]) == 1
    assert "seed=2: SLURM task 1000_1 ended without an answer" in capsys.readouterr().err
    assert [(directory / "result.json").exists() for directory in old] == [True, True, False]
    assert set(state_hashes(tmp_path / "results")) == {directory.name for directory in old[:2]}


@pytest.mark.parametrize(("state", "broken", "shown"), [("PREEMPTED", "", "PREEMPTED"), ("FAILED", "sacct", "UNKNOWN")])
def test_task_that_accounting_calls_unfinished_is_not_waited_for(
    state: str,
    broken: str,
    shown: str,
    cluster: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("FAKE_SLURM_KILL", "1")
    monkeypatch.setenv("FAKE_SLURM_KILLED", state)
    monkeypatch.setenv("FAKE_SLURM_BROKEN", broken)
    assert main([*SWEEP, "seed=0,1", "slurm.trials_per_task=1"]) == 1
    assert f"SLURM task 1000_1 ended without an answer: {shown}" in capsys.readouterr().err
    assert len(state_hashes(tmp_path / "results")) == 1


def test_task_is_gone_when_the_queue_lacks_it_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    pending, no_answer = {"7_0": "PENDING", "7_1": "TIMEOUT"}, None
    answers = iter([{}, {}, pending, no_answer, pending, pending, {}, {}])
    monkeypatch.setattr(queue_module, "task_states", lambda _: next(answers))
    stream = io.StringIO()
    watch = QueueWatch("7", PlainSweep(stream))
    found = [watch.gone(["7_0", "7_1"]) for _ in range(8)]
    assert found == [set(), set(), set(), set(), set(), {"7_1"}, {"7_1"}, {"7_0", "7_1"}]
    assert stream.getvalue().count("squeue says nothing of job 7") == 1


def _states(cluster: Path) -> set[str]:
    return {path.read_text().split()[0] for path in cluster.glob("1000*")}


@pytest.mark.parametrize("broken", ["", "scancel"])
def test_interrupt_cancels_the_whole_array(
    broken: str, cluster: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupt(sweep: PlainSweep, text: str) -> None:
        sys.stderr.write(f"{text}\n")
        if text.startswith("submitted"):
            raise KeyboardInterrupt

    monkeypatch.setattr(PlainSweep, "notice", interrupt)
    monkeypatch.setenv("FAKE_SLURM_BROKEN", broken)
    assert main([*SWEEP, "duration_s=100"]) == 130
    shown = capsys.readouterr().err
    assert ("'scancel 1000' failed; give it again, or tasks run on" in shown) == bool(broken)
    assert shown.endswith("quadlab: interrupted; the same command goes on where it stopped\n")
    monkeypatch.delenv("FAKE_SLURM_BROKEN")
    assert broken or _states(cluster) == {"CANCELLED"}
    fake_slurm.STATE = cluster
    fake_slurm.scancel("1000")


def test_interrupt_while_slurm_takes_the_array_cancels_it(cluster: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    take = submitit.SlurmExecutor.map_array

    def interrupted(*arguments: Any) -> Any:
        jobs = take(*arguments)
        signal.raise_signal(signal.SIGINT)
        return jobs

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    monkeypatch.setattr(submitit.SlurmExecutor, "map_array", interrupted)
    try:
        assert main([*SWEEP, "duration_s=100"]) == 130
    finally:
        signal.signal(signal.SIGINT, before)
    assert _states(cluster) == {"CANCELLED"}


def test_interrupt_is_put_off_to_the_end_of_a_block() -> None:
    reached: list[str] = []

    def interrupted() -> None:
        with interrupts_later():
            signal.raise_signal(signal.SIGINT)
            reached.append("end")

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            interrupted()
    finally:
        signal.signal(signal.SIGINT, before)
    assert reached == ["end"]


def test_without_slurm_the_sweep_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(SWEEP) == 1
    assert "quadlab: SLURM took no job: Could not detect" in capsys.readouterr().err
