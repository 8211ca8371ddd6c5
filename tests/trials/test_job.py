"""What a job leaves behind, when it is skipped, and what an exception turns into."""

import io
import json
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from quadlab.analysis.trial_directory import find_log
from quadlab.errors import LogError, QuadlabError, RobotDescriptionError
from quadlab.trials import job as job_module
from quadlab.trials.compose import compose_document, compose_trial, split_document
from quadlab.trials.config import TrialConfig
from quadlab.trials.identity import trial_id
from quadlab.trials.job import JobOutcome, run_job
from quadlab.trials.main import main
from quadlab.trials.progress import SilentProgress, TrialProgress, terminal_progress
from quadlab.trials.report import job_report
from quadlab.trials.result import TrialResult, TrialStatus

Runner = Callable[[TrialConfig, Path, TrialProgress], TrialResult]


def _result_of(config: TrialConfig, status: TrialStatus = TrialStatus.FELL) -> TrialResult:
    return TrialResult(
        trial_id=trial_id(config),
        status=status,
        status_reason="fell at 1.50 s",
        robot=config.robot.name,
        gait=config.gait.name,
        planner=config.planner.kind,
        controller=config.controller.kind,
        estimator=config.estimator.kind,
        scenario=config.scenario.name,
        seed=config.seed,
        duration_s=config.duration_s,
        survived_s=1.5,
    )


@pytest.fixture
def ran(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Replace the trial by one that falls, or raises where the seed is 13; return the seeds that ran."""
    seeds: list[int] = []

    def run_trial(config: TrialConfig, directory: Path, progress: TrialProgress) -> TrialResult:
        assert (directory / "config.yaml").is_file()
        assert (directory / "manifest.json").is_file()
        seeds.append(config.seed)
        if config.seed == 13:
            raise RuntimeError("boom")
        return _result_of(config)

    monkeypatch.setattr(job_module, "run_trial", run_trial)
    return seeds


def _run(folder: Path, *overrides: str) -> JobOutcome:
    config, options = split_document(compose_document([f"results_dir={folder}", *overrides]))
    return run_job(config, options, SilentProgress())


def test_files_of_a_finished_trial(tmp_path: Path, ran: list[int]) -> None:
    outcome = _run(tmp_path, "tag=here", "seed=2")
    config, _ = split_document(compose_document(["seed=2", "tag=here"]))
    assert outcome.directory == tmp_path / "here" / trial_id(config)
    assert {path.name for path in outcome.directory.iterdir()} == {"config.yaml", "manifest.json", "result.json"}
    assert TrialConfig.model_validate(yaml.safe_load((outcome.directory / "config.yaml").read_text())) == config


def test_finished_trial_is_skipped_unless_forced(tmp_path: Path, ran: list[int]) -> None:
    assert not _run(tmp_path).skipped
    again = _run(tmp_path)
    assert again.skipped
    assert again.result is not None
    assert "force=true" in job_report(again)
    assert not _run(tmp_path, "force=true").skipped
    assert ran == [0, 0]


def test_plans_that_were_not_found_on_the_way_are_told() -> None:
    result = _result_of(compose_trial())
    assert "replannings" not in job_report(JobOutcome(Path(), result))
    replanned = result.model_copy(update={"replannings": 17, "replanning_failures": 16})
    assert "replannings / failed:      17 / 16\n" in job_report(JobOutcome(Path(), replanned))


def test_exception_becomes_error_json_and_the_next_run_tries_again(
    tmp_path: Path, ran: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    outcome = _run(tmp_path, "seed=13")
    assert outcome.result is None
    assert outcome.failure is not None
    assert outcome.failure.startswith("RuntimeError: boom")
    record = json.loads((outcome.directory / "error.json").read_text())
    assert "Traceback" in record["traceback"][0]
    assert not (outcome.directory / "result.json").exists()
    monkeypatch.setattr(job_module, "run_trial", lambda config, *_: _result_of(config))
    assert _run(tmp_path, "seed=13").failure is None
    assert not (outcome.directory / "error.json").exists()


def test_reason_of_several_lines_becomes_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stop(*_: object) -> TrialResult:
        raise RuntimeError("mj_stackAlloc: out of memory, stack overflow\n  max = 1, available = 0\n")

    monkeypatch.setattr(job_module, "run_trial", stop)
    outcome = _run(tmp_path)
    message = "mj_stackAlloc: out of memory, stack overflow; max = 1, available = 0"
    assert str(outcome.failure).startswith(f"RuntimeError: {message} (traceback in ")
    assert json.loads((outcome.directory / "error.json").read_text())["message"] == message


def test_result_that_cannot_be_read_is_exit_code_1_and_says_how_to_replace_it(
    tmp_path: Path, ran: list[int], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    directory = tmp_path / "results" / "trials" / trial_id(compose_trial())
    directory.mkdir(parents=True)
    (directory / "result.json").write_text("{")
    assert main([]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith("; remove it, or add force=true to run the trial again")
    assert main(["force=true"]) == 0


def test_error_within_a_trial_is_no_mistake_in_its_configuration(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(*_: object) -> TrialResult:
        raise QuadlabError("torque command is not finite: LF_HAA")

    monkeypatch.setattr(job_module, "run_trial", stop)
    outcome = _run(tmp_path)
    assert str(outcome.failure).startswith("QuadlabError: torque command is not finite: LF_HAA (traceback in ")
    assert (outcome.directory / "error.json").is_file()


def test_forced_run_that_fails_leaves_no_old_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(job_module, "run_trial", lambda config, *_: _result_of(config))
    directory = _run(tmp_path, "seed=13").directory

    def fail(*_: object) -> TrialResult:
        raise RuntimeError("boom")

    monkeypatch.setattr(job_module, "run_trial", fail)
    assert _run(tmp_path, "seed=13", "force=true").failure
    assert not (directory / "result.json").exists()


def test_rerun_leaves_no_log_of_the_run_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(job_module, "run_trial", lambda config, *_: _result_of(config))
    directory = _run(tmp_path).directory
    for name in ("trial.mcap", "trial.mcap.part", "trial.recovered.mcap"):
        (directory / name).write_text("of the first run")
    unplanned = TrialStatus.PLANNING_FAILED
    monkeypatch.setattr(job_module, "run_trial", lambda config, *_: _result_of(config, unplanned))
    _run(tmp_path, "force=true")
    with pytest.raises(LogError, match="nothing was recorded: planning_failed"):
        find_log(directory)
    assert (directory / "trial.recovered.mcap").is_file()


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_interrupted_trial_gives_the_cursor_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(_: TrialConfig, __: Path, progress: TrialProgress) -> TrialResult:
        progress.start("anymal_b trot", 2.0)
        raise KeyboardInterrupt

    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(job_module, "run_trial", interrupt)
    stream = _Terminal()
    config, options = split_document(compose_document([f"results_dir={tmp_path}"]))
    with pytest.raises(KeyboardInterrupt):
        run_job(config, options, terminal_progress(stream))
    shown, hidden = "\x1b[?25h", "\x1b[?25l"
    assert stream.getvalue().rfind(shown) > stream.getvalue().rfind(hidden) >= 0
    assert "interrupted" in stream.getvalue()


def test_mistake_of_the_user_is_no_program_failure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> TrialResult:
        raise RobotDescriptionError("no such link")

    monkeypatch.setattr(job_module, "run_trial", refuse)
    with pytest.raises(RobotDescriptionError):
        _run(tmp_path)
    assert not list(tmp_path.rglob("error.json"))


def test_fall_is_an_outcome_with_exit_code_0(
    tmp_path: Path, ran: list[int], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["seed=1", "tag=falls"]) == 0
    assert ": fell (fell at 1.50 s)" in capsys.readouterr().out
    assert [path.name for path in tmp_path.iterdir()] == ["results"]


def test_exception_is_exit_code_1_and_one_line(
    tmp_path: Path, ran: list[int], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["seed=13"]) == 1
    lines = [line for line in capsys.readouterr().err.splitlines() if line.startswith("quadlab: ")]
    assert len(lines) == 1
    assert "RuntimeError: boom" in lines[0]
    assert "error.json" in lines[0]


def test_sweep_goes_on_after_a_failure_and_leaves_no_litter(
    tmp_path: Path, ran: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["-m", "seed=1,13,2", "tag=sweep"]) == 1
    assert ran == [1, 13, 2]
    assert [path.name for path in tmp_path.iterdir()] == ["results"]
    assert len(list(tmp_path.glob("results/sweep/*/result.json"))) == 2
    assert main(["-m", "seed=1,2,3", "tag=sweep"]) == 0
    assert ran == [1, 13, 2, 3]
