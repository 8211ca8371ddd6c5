"""What the command line answers: exit codes, one line for each mistake, and quickly where no trial is run."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from quadlab import __version__
from quadlab.cli import main


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


def test_unknown_command_names_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["runn"])
    assert stop.value.code == 2
    assert "recover" in capsys.readouterr().err
