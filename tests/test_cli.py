"""What the command line answers: exit codes, one line for each mistake, and quickly where no trial is run."""

import os
import subprocess
import sys
from importlib.abc import MetaPathFinder
from pathlib import Path

import pytest

from quadlab import __version__
from quadlab.cli import main
from quadlab.errors import os_error_line


def _quadlab(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", "import sys; from quadlab.cli import main; sys.exit(main())", *arguments]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    return subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("run", "robot=anymal_x"), "robot: unknown 'anymal_x'; did you mean 'anymal_"),
        (("gait.nmae=trot",), "gait.nmae: unknown key; did you mean 'name'?"),
        (("run", "seed=-1"), "seed: input should be greater than or equal to 0 (got -1)"),
        (("run", "gait.cycles.x.strides=1"), "Index 'x' (str) is not an int"),
        (("run", "experiment=nothing"), "experiment: unknown 'nothing'; known: bellicoso2016_"),
        (("plan", "shard=hello"), "shard: expected i/n such as 0/4"),
        (("run", "duration_s=[1"), "duration_s=[1: cannot be read as key=value"),
    ],
)
def test_mistake_is_one_line_and_exit_code_2(arguments: tuple[str, ...], expected: str, tmp_path: Path) -> None:
    done = _quadlab(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith(f"quadlab: {expected}")
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""
    assert not list(tmp_path.iterdir())


def test_composed_configuration_is_printed_without_loading_physics(tmp_path: Path) -> None:
    code = (
        "import sys; from quadlab.cli import main; main(['run', 'seed=7', '--cfg', 'job']); "
        "sys.exit(bool({'mujoco', 'pinocchio', 'casadi', 'numba'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, "heavy packages were imported"
    assert "seed: 7" in done.stdout
    assert not list(tmp_path.iterdir())


def test_help_lists_groups_and_options(tmp_path: Path) -> None:
    done = _quadlab("run", "--help", cwd=tmp_path)
    assert done.returncode == 0
    assert "gait: " in done.stdout
    assert "trot" in done.stdout


def test_study_taken_for_an_experiment_is_told_how_to_run(tmp_path: Path) -> None:
    done = _quadlab("run", "experiment=comparison", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.endswith("'comparison' is a study: python experiments/run_study.py comparison\n")


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["--version"])
    assert stop.value.code == 0
    assert capsys.readouterr().out == f"quadlab {__version__}\n"


@pytest.mark.parametrize("command", ["plot", "render", "recover"])
def test_missing_trial_is_one_line_and_exit_code_2(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([command, str(tmp_path / "nothing")]) == 2
    error = capsys.readouterr().err
    assert error.startswith("quadlab: ")
    assert "nothing" in error
    assert error.count("\n") == 1


@pytest.mark.parametrize("command", ["run", "plan", "collect"])
def test_interrupt_is_one_line_and_exit_code_130_also_while_loading(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    module = {
        "run": "quadlab.sweeps.main",
        "plan": "quadlab.plotting.plan_files",
        "collect": "quadlab.analysis.collect",
    }

    class Interrupted(MetaPathFinder):
        def find_spec(self, name: str, *_: object) -> None:
            if name == module[command]:
                raise KeyboardInterrupt

    monkeypatch.delitem(sys.modules, module[command], raising=False)
    monkeypatch.setattr(sys, "meta_path", [Interrupted(), *sys.meta_path])
    assert main([command, str(tmp_path)]) == 130
    assert capsys.readouterr().err == "quadlab: interrupted\n"


def test_reader_of_the_output_that_has_gone_is_no_error_message(tmp_path: Path) -> None:
    code = "import sys; from quadlab.cli import main; input(); sys.exit(main(['run', '--help']))"
    command = [sys.executable, "-c", code]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, cwd=tmp_path, stdin=pipe, stdout=pipe, stderr=pipe, text=True) as process:
        assert process.stdin and process.stdout and process.stderr
        process.stdout.close()
        process.stdin.write("\n")
        process.stdin.flush()
        assert process.stderr.read() == ""
    assert process.returncode == 1


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (OSError(28, "No space left on device", "results/x"), "results/x: No space left on device"),
        (OSError("Failed to open\n  'x'"), "Failed to open; 'x'"),
        (OSError(), "OSError"),
    ],
)
def test_every_error_of_the_file_system_is_one_line(error: OSError, line: str) -> None:
    assert os_error_line(error) == line


def test_unknown_command_names_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["runn"])
    assert stop.value.code == 2
    assert "recover" in capsys.readouterr().err
