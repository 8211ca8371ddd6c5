"""Planning without running: what it prints, leaves behind and refuses."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from quadlab.analysis.log_reader import read_log
from quadlab.cli import main
from quadlab.planners.plan_io import load_plan
from quadlab.trials.compose import compose_trial
from quadlab.trials.identity import trial_id
from quadlab.trials.plan_job import PLAN_FILE
from quadlab.trials.progress import SilentProgress
from quadlab.trials.runner import run_trial

WALK = ["gait=walk", "planner=zmp_spline", "duration_s=7"]
FIGURES = {"plan.png", "plan.pdf", "plan_3d.png", "plan_3d.pdf"}


def plan_in(folder: Path, *overrides: str) -> tuple[int, Path]:
    code = main(["plan", *overrides, f"results_dir={folder}", "tag=test"])
    return code, folder / "test" / f"plan_{trial_id(compose_trial(overrides))}"


def test_plan_is_printed_by_name_saved_and_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, directory = plan_in(tmp_path, *WALK)
    assert code == 0
    printed = capsys.readouterr().out
    plan = load_plan(directory / PLAN_FILE)
    assert printed.startswith("solved: ")
    for name in [*plan.report.costs, *plan.report.residuals, *plan.verdict.values, "build / solve", "variables"]:
        assert name in printed
    assert str(plan.report.variables) in printed
    assert str(directory) in printed
    assert {path.name for path in directory.iterdir()} == {"config.yaml", PLAN_FILE, *FIGURES}


def test_first_use_on_a_machine_prints_nothing_but_the_result(tmp_path: Path) -> None:
    """Matplotlib then looks for fonts, and would say so."""
    program = "import sys; from quadlab.cli import main; sys.exit(main(sys.argv[1:]))"
    command = [sys.executable, "-c", program, "plan", *WALK, f"results_dir={tmp_path}"]
    fresh = {**os.environ, "MPLCONFIGDIR": str(tmp_path / "matplotlib")}
    done = subprocess.run(command, check=True, env=fresh, capture_output=True, text=True, timeout=300)
    assert done.stdout.startswith("solved: "), done.stdout


def test_plan_is_the_one_that_the_trial_follows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    overrides = ["gait=trot", "scenario=perturbed", "seed=4", "duration_s=2.2"]
    _, directory = plan_in(tmp_path, *overrides)
    run_trial(compose_trial(overrides), tmp_path, SilentProgress())
    alone, followed = load_plan(directory / PLAN_FILE), read_log(tmp_path / "trial.mcap").plan
    for mine, theirs in zip(alone.footholds, followed.footholds, strict=True):
        np.testing.assert_array_equal(mine, theirs)
    for time in np.linspace(0.0, alone.duration_s, 20):
        np.testing.assert_array_equal(alone.com(time), followed.com(time))


def test_infeasible_plan_is_an_answer_and_leaves_no_older_plan(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    impossible = ["gait=trot", "planner=zmp_spline", "duration_s=3"]
    _, directory = plan_in(tmp_path, *impossible)
    (directory / PLAN_FILE).write_bytes(b"older")
    capsys.readouterr()
    code, directory = plan_in(tmp_path, *impossible)
    assert code == 0
    assert capsys.readouterr().out.startswith("infeasible: zmp_in_support_m")
    assert {path.name for path in directory.iterdir()} == {"config.yaml"}


@pytest.mark.parametrize(
    ("override", "expected"),
    [
        ("planer=zmp_spline", "planer: unknown key; did you mean 'planner'?"),
        ("planner=zmp", "planner: unknown 'zmp'"),
        ("planner.qp_solver=magic", "planner.qp_solver:"),
        ("replanning.period_s=0", "replanning.period_s:"),
    ],
)
def test_mistake_is_one_line_and_exit_code_2(
    override: str, expected: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plan", *WALK, override, f"results_dir={tmp_path}"]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"quadlab: {expected}")
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_results_folder_that_is_a_file_is_one_line_and_exit_code_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    taken = tmp_path / "taken"
    taken.write_text("")
    assert main(["plan", *WALK, f"results_dir={taken}"]) == 1
    error = capsys.readouterr().err
    assert error.startswith(f"quadlab: {taken}/")
    assert error.endswith(": Not a directory\n")
    assert error.count("\n") == 1
