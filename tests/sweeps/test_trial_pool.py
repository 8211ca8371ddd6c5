"""A sweep gives what single trials give, whatever the number of workers, and loses none of them."""

import io
import json
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest
from sweep_cases import FREE, run, standing

from quadlab.sweeps.options import Shard
from quadlab.sweeps.terminal import PlainSweep
from quadlab.sweeps.trial_pool import SweepTrial, run_trials, unique_trials, without_old_results
from quadlab.sweeps.warm_up import import_trials, warm_up
from quadlab.trials import manifest as manifest_module
from quadlab.trials.config import RunOptions, TrialConfig
from quadlab.trials.job import run_job, trial_directory
from quadlab.trials.lock import running
from quadlab.trials.progress import SilentProgress
from quadlab.trials.result import RESULT_FILE


def test_results_are_those_of_single_runs_whatever_the_number_of_workers(tmp_path: Path) -> None:
    trials = standing(3)
    alone = {
        trial.name: run_job(trial.config, RunOptions(force=False, results_dir=str(tmp_path)), SilentProgress()).result
        for trial in trials
    }
    for workers in (1, 2):
        outcomes = run(trials, tmp_path / str(workers), FREE.model_copy(update={"workers": workers}))
        assert len(outcomes) == 3
        for name, job in outcomes.items():
            assert job.result is not None
            assert alone[name] is not None
            assert job.result.state_sha256 == alone[name].state_sha256  # type: ignore[union-attr]


def test_finished_trials_are_not_run_again_and_equal_ones_are_run_once(tmp_path: Path) -> None:
    first = run(standing(1), tmp_path)
    log = next(tmp_path.rglob("trial.mcap"))
    written = log.stat().st_mtime_ns
    again = run([*standing(2), SweepTrial("the same", standing(2)[1].config)], tmp_path)
    assert not first["seed=0"].skipped
    assert {name: job.skipped for name, job in again.items()} == {"seed=0": True, "seed=1": False}
    assert log.stat().st_mtime_ns == written


def test_forced_sweep_leaves_a_trial_to_the_process_that_runs_it(tmp_path: Path) -> None:
    """Its unfinished log must not be taken away from under it; its result will be new."""
    (trial,) = standing(1)
    forced = RunOptions(force=True, results_dir=str(tmp_path))
    directory = trial_directory(trial.config, forced)
    with running(directory):
        part = directory / "trial.mcap.part"
        part.touch()
        without_old_results([trial], forced)
        assert part.exists()
    without_old_results([trial], forced)
    assert not part.exists()


def test_forced_sweep_that_was_left_goes_on_without_force(tmp_path: Path) -> None:
    trials = standing(2)
    run(trials, tmp_path)
    forced = RunOptions(force=True, results_dir=str(tmp_path))
    with closing(run_trials(trials, forced, FREE.model_copy(update={"workers": 1}))) as outcomes:
        assert not next(outcomes).job.skipped
    (done,) = (path.parent.name for path in tmp_path.rglob(RESULT_FILE))
    again = run(trials, tmp_path)
    assert {job.directory.name: job.skipped for job in again.values()}[done]
    assert [job.skipped for job in again.values()].count(True) == 1


def test_same_trial_under_two_tags_is_run_for_both(tmp_path: Path) -> None:
    trials = [standing(1, f"tag={tag}")[0] for tag in ("a", "b")]
    assert unique_trials(trials) == trials
    halves = [Shard.model_validate(f"{number}/2") for number in range(2)]
    parts = [part.of(trials) for part in halves]
    assert [part.of(trials[::-1]) for part in halves] == parts
    assert sorted(trial.config.tag for part in parts for trial in part) == ["a", "b"]


def test_trial_that_waits_for_another_process_is_no_failure_of_its_own(tmp_path: Path) -> None:
    trials, limited = standing(1), FREE.model_copy(update={"time_limit_s": 2.0})
    options = RunOptions(force=False, results_dir=str(tmp_path))
    with running(trial_directory(trials[0].config, options)):
        job = run(trials, tmp_path, limited)["seed=0"]
    assert str(job.failure) == "ran longer than 2 s; another process runs the trial now"
    assert not list(tmp_path.rglob("error.json"))


def test_equal_trials_are_said_to_be_run_once() -> None:
    stream = io.StringIO()
    trials = standing(2)
    assert unique_trials([*trials, *trials], PlainSweep(stream)) == trials
    assert "2 trials are equal to others and will be run once" in stream.getvalue()
    assert unique_trials(trials, PlainSweep(stream)) == trials
    assert stream.getvalue().count("equal") == 1


@pytest.mark.parametrize("preload", [import_trials, lambda: warm_up(())], ids=["importing", "warming up"])
def test_trials_name_the_code_that_was_loaded_whatever_is_committed_meanwhile(
    preload: Callable[[], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    config = standing(1)[0].config
    loaded = _code_of(config)
    manifest_module.git_state.cache_clear()
    manifest_module.lock_hash.cache_clear()
    preload()
    monkeypatch.setattr(manifest_module, "_git", lambda *_: b"0" * 40)
    monkeypatch.setattr(manifest_module, "sha256", lambda _: "0" * 64)
    assert _code_of(config) == loaded


def _code_of(config: TrialConfig) -> list[object]:
    found = manifest_module.collect_manifest(config)
    return [found["git"], found["lock_sha256"]]


def test_trial_that_takes_too_long_leaves_its_reason_and_no_result(tmp_path: Path) -> None:
    trials = standing(1, "duration_s=60")
    job = run(trials, tmp_path, FREE.model_copy(update={"time_limit_s": 1.0}))["seed=0"]
    assert job.result is None
    assert str(job.failure).startswith("ran longer than 1 s")
    assert json.loads((job.directory / "error.json").read_text())["type"] == "timed_out"
    assert (job.directory / "config.yaml").is_file()
    assert not (job.directory / RESULT_FILE).exists()


def test_result_that_cannot_be_read_is_reported_and_left_alone(tmp_path: Path) -> None:
    trials = standing(2)
    directory = trial_directory(trials[0].config, RunOptions(force=False, results_dir=str(tmp_path)))
    directory.mkdir(parents=True)
    (directory / RESULT_FILE).write_text('{"trial_id": ')
    outcomes = run(trials, tmp_path)
    assert "not JSON" in str(outcomes["seed=0"].failure)
    assert outcomes["seed=1"].result is not None
    assert (directory / RESULT_FILE).read_text() == '{"trial_id": '


def test_mistake_that_only_the_trial_finds_is_its_failure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    trial = standing(1)[0]
    robot = trial.config.robot.model_copy(update={"urdf": "nowhere.urdf"})
    broken = SweepTrial("broken", trial.config.model_copy(update={"robot": robot}))
    (outcome,) = run_trials([broken], RunOptions(force=False, results_dir=str(tmp_path / "results")), FREE)
    assert outcome.job.result is None
    assert "nowhere.urdf" in str(outcome.job.failure)
