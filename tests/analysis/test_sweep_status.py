"""Status names what is missing, failed, half-written and stale; clean removes what never finished and nothing else."""

import errno
import fcntl
import os
import re
import shutil
from contextlib import ExitStack
from pathlib import Path

import pytest
from synthetic_records import write_log
from trial_folders import begin, fail, finish, options

from quadlab import sweep_commands
from quadlab.analysis import inventory
from quadlab.analysis import sweep_status as status_module
from quadlab.analysis.clean import find_litter
from quadlab.analysis.trial_directory import find_log
from quadlab.cli import main
from quadlab.sweeps.record import record_sweep
from quadlab.sweeps.trial_pool import SweepTrial
from quadlab.trials.compose import compose_trial
from quadlab.trials.lock import running

OLD = "a" * 40


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with one trial in each state, and the code at the commit of most of them."""
    monkeypatch.setattr(status_module, "git_state", lambda _: {"commit": "c" * 40})
    config = compose_trial()
    trials = [SweepTrial(f"seed={seed}", config.model_copy(update={"seed": seed})) for seed in range(6)]
    record_sweep(trials, options(tmp_path))
    finish(tmp_path, "seed=0")
    finish(tmp_path, "seed=1", commit=OLD)
    fail(tmp_path, "seed=2")
    begin(tmp_path, "seed=3")
    (finish(tmp_path, "seed=4") / "result.json").write_text("{}")
    return tmp_path / "trials"


def test_every_trial_that_is_not_fine_is_named(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["status", str(folder)]) == 1
    first, *lines = capsys.readouterr().out.splitlines()
    assert first.startswith(f"{folder}: 6 asked for, 2 finished (2 completed), ")
    assert "1 missing, 1 stale" in first
    words = {word: next(line for line in lines if word in line) for word in ("failed", "half-written", "unreadable")}
    assert words["failed"].endswith("(seed=2): died: killed by SIGKILL")
    assert words["half-written"].endswith("(seed=3)")
    assert "(seed=4): " in words["unreadable"]
    assert any(line.endswith("(seed=5)") and "missing" in line for line in lines)
    assert any(line.endswith("(seed=1): commit aaaaaaaaaa, now cccccccccc") for line in lines)
    record = re.escape(str(folder / "sweeps")) + "/[0-9a-f]{16}\\.json"
    assert any(re.search(f"{record} asked for 1 of the missing; remove it if", line) for line in lines)
    assert len(lines) == 6


def _record(results: Path, tag: str, *seeds: int) -> None:
    config = compose_trial([f"tag={tag}"])
    trials = [SweepTrial(f"seed={seed}", config.model_copy(update={"seed": seed})) for seed in seeds]
    record_sweep(trials, options(results))


def test_what_a_tag_lacks_its_parent_lacks_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(status_module, "git_state", lambda _: {"commit": OLD})
    _record(tmp_path, "one", 0)
    _record(tmp_path, "two", 0, 1)
    for tag in ("one", "two"):
        finish(tmp_path, "seed=0", f"tag={tag}")
    assert main(["status", str(tmp_path / "two")]) == 1
    assert main(["status", str(tmp_path)]) == 1
    shown = capsys.readouterr().out
    assert "2 asked for" in shown
    assert "3 asked for" in shown
    assert shown.count("  missing  ") == 2
    assert "  stale         one/" in shown


def test_trial_that_only_another_tag_has_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(status_module, "git_state", lambda _: None)
    for tag in ("one", "two"):
        _record(tmp_path, tag, 0)
    name = finish(tmp_path, "seed=0", "tag=one").name
    assert main(["status", str(tmp_path)]) == 1
    first, missing, record = capsys.readouterr().out.splitlines()
    assert first.endswith("2 asked for, 1 finished (1 completed), 1 missing")
    assert missing == f"  missing       two/{name} (seed=0)"
    assert record.startswith(f"  {tmp_path}/two/sweeps/")


@pytest.mark.parametrize("inside", ["", "tag/sweeps", "tag/0123456789abcdef"])
def test_folder_without_trials_is_a_mistake(tmp_path: Path, inside: str, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / inside).mkdir(parents=True, exist_ok=True)
    assert main(["status", str(tmp_path / inside)]) == 2
    assert capsys.readouterr().err == (
        f"quadlab: {tmp_path / inside}: no trial in it, and no sweep asked for one; expected results/<tag>\n"
    )


@pytest.mark.parametrize("content", [b"\xff", b"{", b'["ab"]', b'{"0": 1}'])
def test_record_that_is_none_is_one_line(tmp_path: Path, content: bytes, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "sweeps").mkdir()
    (tmp_path / "sweeps/x.json").write_bytes(content)
    assert main(["status", str(tmp_path)]) == 2
    assert capsys.readouterr().err.startswith(f"quadlab: {tmp_path}/sweeps/x.json: not the record of a sweep (")


def test_finished_trial_without_its_configuration_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(status_module, "git_state", lambda _: None)
    directory = finish(tmp_path, "seed=0")
    (directory / "config.yaml").unlink()
    assert main(["status", str(tmp_path)]) == 1
    first, line = capsys.readouterr().out.splitlines()
    assert first.endswith("1 finished (1 completed), 1 config unreadable")
    assert line.startswith(f"  config unreadable  trials/{directory.name}: no config.yaml that can be read")


def test_complete_folder_is_exit_code_0(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(status_module, "git_state", lambda _: None)
    finish(tmp_path, "seed=0")
    assert main(["status", str(tmp_path)]) == 0


def test_trial_that_runs_now_is_neither_half_written_nor_cleaned(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    parts = [path for path in folder.glob("*/*.part") if not (path.parent / "error.json").exists()]
    directory = parts[0].parent
    with running(directory):
        main(["status", str(folder)])
        assert "1 running" in capsys.readouterr().out
        assert main(["clean", str(folder), "--yes"]) == 0
        assert directory.is_dir()
    assert main(["clean", str(folder), "--yes"]) == 0
    assert not directory.exists()


def test_clean_keeps_every_result_even_one_that_cannot_be_read(folder: Path) -> None:
    results = {path: path.read_bytes() for path in folder.rglob("result.json")}
    assert len(results) == 3
    assert main(["clean", str(folder), "--yes"]) == 0
    assert {path: path.read_bytes() for path in folder.rglob("result.json")} == results
    assert len([path for path in folder.iterdir() if len(path.name) == 16]) == 3


def test_clean_needs_no_configuration(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: object) -> None:
        raise AssertionError("a configuration was read")

    monkeypatch.setattr(inventory, "load_yaml", refuse)
    assert find_litter(folder)


def test_clean_asks_first(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = sorted(folder.rglob("*"))
    assert main(["clean", str(folder)]) == 2
    assert "--yes" in capsys.readouterr().err
    assert sorted(folder.rglob("*")) == before


def test_clean_keeps_a_recovered_log(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    directory, _ = begin(tmp_path, "seed=0")
    write_log(directory / "whole.mcap", ticks=5).rename(directory / "trial.mcap.part")
    assert main(["recover", str(directory / "trial.mcap.part")]) == 0
    rescued = find_log(directory)
    assert main(["clean", str(tmp_path), "--yes"]) == 0
    assert list(directory.iterdir()) == [rescued]
    capsys.readouterr()
    assert main(["clean", str(tmp_path), "--yes"]) == 0
    assert capsys.readouterr().out == f"{tmp_path}: nothing that never finished\n"


def test_clean_leaves_what_runs_or_has_changed_since_it_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    runs, finished, noted, gone, dead = (begin(tmp_path, f"seed={seed}")[0] for seed in range(5))
    kept = [*runs.iterdir(), *finished.iterdir()]
    with ExitStack() as stack:

        def meanwhile(*_: object) -> bool:
            stack.enter_context(running(runs))
            shutil.copy(finish(tmp_path / "elsewhere", "seed=1") / "result.json", finished)
            (noted / "notes.txt").touch()
            shutil.rmtree(gone)
            return True

        monkeypatch.setattr(sweep_commands, "_confirmed", meanwhile)
        assert main(["clean", str(tmp_path)]) == 0
        left = [line for line in capsys.readouterr().out.splitlines() if line.startswith("left ")]
        assert sorted(left) == sorted(
            [
                f"left {runs}: a process runs it now",
                f"left {finished}: it has changed meanwhile",
                f"left {noted}: it has changed meanwhile",
            ]
        )
    assert all(path.exists() for path in kept)
    assert not dead.exists()


def test_clean_without_locks_leaves_what_may_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def no_locks(*_: object) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr(fcntl, "flock", no_locks)
    (may_run, _), (dead, _) = begin(tmp_path, "seed=0"), begin(tmp_path, "seed=1")
    (may_run / ".lock").touch()
    before = sorted(may_run.iterdir())
    assert main(["clean", str(tmp_path), "--yes"]) == 0
    assert f"left {may_run}: no locks on its file system, and .lock says that it may run" in capsys.readouterr().out
    assert sorted(may_run.iterdir()) == before
    assert not dead.exists()


def test_clean_leaves_what_somebody_else_put_there(tmp_path: Path) -> None:
    directory, _ = begin(tmp_path, "seed=0")
    (directory / "notes.txt").write_text("mine")
    assert main(["clean", str(tmp_path), "--yes"]) == 0
    assert [path.name for path in directory.iterdir()] == ["notes.txt"]


def test_clean_removes_half_written_files_beside_a_result(tmp_path: Path) -> None:
    directory = finish(tmp_path, "seed=0")
    (directory / "result.json.17.part").write_text("{")
    assert main(["clean", str(tmp_path), "--yes"]) == 0
    assert {path.name for path in directory.iterdir()} == {"config.yaml", "manifest.json", "result.json", "trial.mcap"}
