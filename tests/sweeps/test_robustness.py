"""Whatever happens to processes, disks and files: a clear line, nothing lost, nothing half-written read as whole."""

import errno
import fcntl
import json
import multiprocessing
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from sweep_cases import STANDING, run, standing

from quadlab.sweeps.trial_pool import SweepTrial
from quadlab.trials import job as job_module
from quadlab.trials.config import RunOptions
from quadlab.trials.files import write_json
from quadlab.trials.job import record_failure, run_job, trial_directory
from quadlab.trials.lock import is_running, running
from quadlab.trials.main import main
from quadlab.trials.progress import SilentProgress
from quadlab.trials.result import RESULT_FILE, TrialResult
from quadlab.trials.runner import run_trial

SCRIPT = Path(__file__).parents[2] / "experiments" / "sweep_robustness.py"


def _options(folder: Path) -> RunOptions:
    return RunOptions(force=False, results_dir=str(folder))


@pytest.mark.skipif(not SCRIPT.is_file(), reason="needs a source tree")
def test_killed_workers_and_a_killed_sweep_change_no_row(tmp_path: Path) -> None:
    command = [sys.executable, str(SCRIPT), "--trials", "4", "--kills", "1", "--folder", str(tmp_path)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "killed 1 workers, then the sweep" in done.stdout
    assert done.stdout.endswith("4 rows, 0 differences\n")
    again = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert again.returncode == 2
    assert "has trials from before, which would not be run again" in again.stderr


def test_full_disk_is_one_line_and_leaves_no_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(_: Path, __: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "result.json")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(job_module, "write_result", full)
    monkeypatch.setattr(job_module, "write_json", full)
    assert main([*STANDING]) == 1
    assert "quadlab: result.json: No space left on device\n" in capsys.readouterr().err
    assert not list(tmp_path.rglob(RESULT_FILE))
    assert not list(tmp_path.rglob("*.json.*"))


def test_failure_that_cannot_be_recorded_is_still_reported(tmp_path: Path) -> None:
    (tmp_path / "trials").write_text("a file where a folder should be")
    job = record_failure(standing(1)[0].config, _options(tmp_path), "died", "killed by SIGKILL", "")
    assert job.result is None
    assert str(job.failure).startswith("killed by SIGKILL (error.json cannot be written: ")


def test_results_that_cannot_be_written_fail_every_trial_and_not_the_sweep(tmp_path: Path) -> None:
    (tmp_path / "trials").write_text("a file where a folder should be")
    outcomes = run(standing(2), tmp_path)
    assert len(outcomes) == 2
    assert all("Error" in str(job.failure) for job in outcomes.values())


def _slow_trial(folder: str, began: str) -> None:
    def slowly(*arguments: Any) -> TrialResult:
        Path(began).touch()
        time.sleep(1.0)
        return run_trial(*arguments)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(job_module, "run_trial", slowly)
        assert run_job(standing(1)[0].config, _options(Path(folder)), SilentProgress()).result is not None


def test_second_process_waits_for_a_trial_that_runs_and_takes_its_result(tmp_path: Path) -> None:
    began = tmp_path / "began"
    first = multiprocessing.get_context("spawn").Process(target=_slow_trial, args=(str(tmp_path), str(began)))
    first.start()
    while not began.exists():
        assert first.is_alive()
        time.sleep(0.02)
    directory = trial_directory(standing(1)[0].config, _options(tmp_path))
    assert is_running(directory)
    outcome = run_job(standing(1)[0].config, _options(tmp_path), SilentProgress())
    first.join()
    assert first.exitcode == 0
    assert outcome.skipped
    assert not is_running(directory)
    assert not (directory / ".lock").exists()


def test_lock_of_a_process_that_died_holds_nobody_up(tmp_path: Path) -> None:
    (tmp_path / ".lock").touch()
    assert not is_running(tmp_path)
    with running(tmp_path):
        assert is_running(tmp_path)


def test_who_only_looks_needs_no_write_access_and_disturbs_nobody_who_looks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / ".lock").touch()
    opened = os.open

    def read_only(path: Path, how: int, *mode: int) -> int:
        assert not how & (os.O_RDWR | os.O_WRONLY)
        return opened(path, how, *mode)

    with (tmp_path / ".lock").open("rb") as other:
        fcntl.flock(other, fcntl.LOCK_SH)
        monkeypatch.setattr(os, "open", read_only)
        assert not is_running(tmp_path)


def test_directory_that_is_removed_before_it_is_held_is_made_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    directory, opened = tmp_path / "trial", os.open

    def remove_first(path: Path, *how: int) -> int:
        monkeypatch.setattr(os, "open", opened)
        directory.rmdir()
        return opened(path, *how)

    monkeypatch.setattr(os, "open", remove_first)
    with running(directory):
        assert is_running(directory)


def test_lock_of_another_process_is_not_removed_with_the_own(tmp_path: Path) -> None:
    with running(tmp_path):
        (tmp_path / ".lock").unlink()
        (tmp_path / ".lock").touch()
    assert (tmp_path / ".lock").exists()


def test_equal_process_ids_on_two_machines_do_not_write_one_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    used: list[object] = []
    monkeypatch.setattr(os, "replace", lambda part, _: used.append(part))
    for _ in range(2):
        write_json(tmp_path / RESULT_FILE, {})
    assert len(set(used)) == 2


def test_half_written_result_is_never_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / RESULT_FILE
    write_json(target, {"old": 1})

    def die(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "replace", die)
    with pytest.raises(OSError, match="No space"):
        write_json(target, {"new": 2})
    assert json.loads(target.read_text()) == {"old": 1}
    assert [path.name for path in tmp_path.iterdir()] == [RESULT_FILE]


def test_clock_that_jumps_changes_no_time_that_is_measured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(time, "time", lambda: -1e9)
    jobs = run([SweepTrial("one", standing(1)[0].config)], tmp_path)
    assert jobs["one"].result is not None
    assert (jobs["one"].result.real_time_factor or 0.0) > 0.0
