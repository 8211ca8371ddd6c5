"""The command that runs studies answers a mistake in one line and exit code 2."""

import subprocess
import sys
from collections.abc import Generator
from pathlib import Path

import pytest

from quadlab.errors import PoolError
from quadlab.studies import work_off
from quadlab.studies.main import main
from quadlab.sweeps.job import EventHandler, Notice, Outcome


def test_unknown_study_names_the_closest_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["aceptance", "--results", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("quadlab: unknown study 'aceptance'; did you mean 'acceptance'")
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_folder_of_results_that_is_a_file_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    taken = tmp_path / "taken"
    taken.write_text("")
    assert main(["gehring2017_trot_plan", "--results", str(taken)]) == 1
    assert capsys.readouterr().err == f"quadlab: {taken}/gehring2017_trot_plan: Not a directory\n"


def test_workers_that_cannot_be_started_are_told_and_no_mistake_of_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def no_pool(_: object, __: object, on_event: EventHandler, ___: object) -> Generator[Outcome, None, None]:
        on_event(Notice("imports: the process that starts the workers was killed by SIGKILL"))
        raise PoolError("workers cannot be started; see the messages above")
        yield

    monkeypatch.setattr(work_off, "run_pool", no_pool)
    assert main(["gehring2017_trot_plan", "--results", str(tmp_path)]) == 1
    captured = capsys.readouterr()
    assert captured.out.endswith("imports: the process that starts the workers was killed by SIGKILL\n")
    assert captured.err == "quadlab: workers cannot be started; see the messages above\n"


def test_reader_that_has_gone_is_no_mistake(tmp_path: Path) -> None:
    code = "import sys; from quadlab.studies.main import main; sys.exit(main(sys.argv[1:]))"
    command = [sys.executable, "-c", code, "gehring2017_trot_plan", "--results", str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        process.stdout.close()
        assert process.stderr is not None
        assert process.stderr.read() == ""
    assert process.returncode == 1


@pytest.mark.parametrize("jobs", ["0", "-1", "two"])
def test_number_of_processes_is_above_zero(jobs: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["acceptance", "--jobs", jobs])
    assert stop.value.code == 2
    assert f"expected a whole number above 0 (got '{jobs}')" in capsys.readouterr().err
