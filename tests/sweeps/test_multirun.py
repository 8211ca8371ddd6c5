"""A sweep of the command line: which trials it means, what is refused before anything runs, what the exit code says."""

import signal
import subprocess
import sys
import time
from io import StringIO
from pathlib import Path

import pytest
from sweep_cases import STANDING, standing

from quadlab.errors import ConfigurationError
from quadlab.paths import CONF_DIR
from quadlab.sweeps import multirun
from quadlab.sweeps.main import is_sweep, main
from quadlab.sweeps.multirun import check_sweep, sweep_points
from quadlab.sweeps.options import Shard
from quadlab.sweeps.terminal import PlainSweep
from quadlab.trials.identity import trial_id

ENTRY = "import sys; from quadlab.sweeps.main import main; sys.exit(main())"


def test_all_combinations_in_the_order_written() -> None:
    names = [point.name for point in sweep_points(["gait=walk,trot", "tag=x", "seed=range(0,2)"])]
    assert names == ["gait=walk seed=0", "gait=walk seed=1", "gait=trot seed=0", "gait=trot seed=1"]


def test_points_compose_to_what_single_runs_would_be() -> None:
    sweep = check_sweep(sweep_points(["seed=0,7", *STANDING[:-1], "duration_s=1"]))
    alone = standing(8, "duration_s=1")
    assert [trial.config for trial in sweep.trials] == [alone[0].config, alone[7].config]


def test_last_override_of_a_key_counts() -> None:
    (point,) = sweep_points(["seed=1,2", "seed=3"])
    assert point.overrides == ("seed=3",)


def test_glob_finds_files() -> None:
    names = {point.name for point in sweep_points(["planner=glob(*)"])}
    assert names == {f"planner={path.stem}" for path in CONF_DIR.glob("planner/*.yaml")}


@pytest.mark.parametrize(
    ("overrides", "lines"),
    [
        (["seed=interval(0,1)"], ["seed=interval(0,1): an interval has no list of values; write seed=a,b,c"]),
        (["seed=range(0,0)"], ["seed=range(0,0): no values"]),
        (["seed=glob(*)"], ["seed=glob(*): no values"]),
        (["seed=0,1", "duration_s=[1"], ["duration_s=[1: cannot be read as key=value"]),
        (
            ["gait=trto,walk", "seed=0,-1"],
            ["gait: unknown 'trto'; did you mean 'trot'?", "seed: input should be greater"],
        ),
        (["force=true,false"], ["force, results_dir, pool, slurm and shard are those of the whole sweep"]),
        (["seed=0,1", "shard=2/2"], ["shard: 2/2 does not exist; the first of n is 0/n"]),
        (["seed=0,1", "shard=half"], ["shard: expected i/n such as 0/4 (got 'half')"]),
        (["seed=0,1", "pool.workers=0"], ["pool.workers: input should be greater than or equal to 1 (got 0)"]),
        (["seed=0,1", "pool.wokers=1"], ["pool.wokers: unknown key; did you mean 'workers'?"]),
    ],
)
def test_mistakes_are_lines_and_nothing_runs(
    overrides: list[str],
    lines: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["-m", *overrides]) == 2
    found = [line for line in capsys.readouterr().err.splitlines() if line.startswith("quadlab: ")]
    assert len(found) == len(lines)
    assert all(shown.startswith(f"quadlab: {line}") for shown, line in zip(found, lines, strict=True))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("overrides", "lines"),
    [
        (
            ["gait=walk,trot"],
            ["gait=walk,trot: several values; add -m for a sweep, or write gait=[walk,trot] for a list"],
        ),
        (["seed=range(0,3)"], ["seed=range(0,3): several values; add -m for a sweep"]),
        (
            ["shard=hello", "pool.workers=-3"],
            [
                "pool.workers: input should be greater than or equal to 1 (got -3)",
                "shard: expected i/n such as 0/4 (got 'hello')",
            ],
        ),
    ],
)
def test_single_trial_is_told_what_belongs_to_sweeps(
    overrides: list[str],
    lines: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(overrides) == 2
    assert capsys.readouterr().err.splitlines() == [f"quadlab: {line}" for line in lines]
    assert not list(tmp_path.iterdir())


def test_launcher_of_another_package_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["-m", "seed=0,1", "hydra/launcher=abacus"]) == 2
    assert capsys.readouterr().err.endswith("; others are packages, e.g. pip install hydra-ray-launcher\n")


def test_checking_many_trials_says_how_far_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(multirun, "TOLD_EVERY_S", 0.0)
    output = StringIO()
    check_sweep(sweep_points(["seed=0,1,2"]), PlainSweep(output))
    assert output.getvalue().splitlines() == [f"sweep: {number} of 3 trials checked" for number in range(3)]


def test_results_folder_that_is_a_file_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "taken").write_text("")
    assert main(["-m", *STANDING, "seed=0,1", "results_dir=taken"]) == 1
    assert capsys.readouterr().err.splitlines()[-1].startswith("quadlab: taken/trials/sweeps: Not a directory")


@pytest.mark.parametrize("count", [1, 2, 3, 7])
def test_shards_share_the_trials_evenly_and_without_overlap(count: int) -> None:
    trials = standing(7)
    parts = [Shard.model_validate(f"{index}/{count}").of(trials) for index in range(count)]
    names = [trial.name for part in parts for trial in part]
    assert sorted(names) == sorted(trial.name for trial in trials)
    assert max(map(len, parts)) - min(map(len, parts)) <= 1


def test_shard_does_not_depend_on_the_order_of_the_trials() -> None:
    trials, half = standing(6), Shard.model_validate("0/2")
    ids = {trial_id(trial.config) for trial in half.of(trials)}
    assert ids == {trial_id(trial.config) for trial in half.of(trials[::-1])}


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["-m", "seed=1,2"], True),
        (["seed=1,2", "--multirun", "launcher=slurm"], True),
        (["seed=1"], False),
        (["-m", "seed=1,2", "--cfg", "job"], False),
        (["-m", "seed=1,2", "hydra/launcher=ray"], False),
        (["-m", "seed=1,2", "launcher=ray"], False),
    ],
)
def test_who_runs_the_arguments(arguments: list[str], expected: bool) -> None:
    assert is_sweep(arguments) is expected


def test_unknown_sweeper_value_of_an_experiment_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ConfigurationError, match="unknown"):
        sweep_points(["experiment=nothing", "seed=1,2"])


def test_trial_that_fails_is_exit_code_1_and_the_others_have_results(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["-m", *STANDING, "duration_s=0.2,100", "pool.time_limit_s=3"]) == 1
    assert "duration_s=100: ran longer than 3 s" in capsys.readouterr().err
    assert len(list(tmp_path.rglob("result.json"))) == 1
    assert len(list(tmp_path.rglob("error.json"))) == 1


@pytest.mark.parametrize("force", [[], ["force=true"]], ids=["", "forced"])
def test_interrupt_ends_the_sweep_with_130_and_says_how_to_go_on(tmp_path: Path, force: list[str]) -> None:
    heeds = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "  # a background job ignores it
    command = [sys.executable, "-c", heeds + ENTRY, "-m", *STANDING, "duration_s=100", "seed=0,1", *force]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 120.0
    while len(list(tmp_path.rglob("trial.mcap.part"))) < 2 and time.monotonic() < deadline:
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, shown = process.communicate(timeout=30.0)
    assert process.returncode == 130
    how = " without force=true" if force else ""
    assert shown.endswith(f"quadlab: interrupted; the same command{how} goes on where it stopped\n")
    assert "Traceback" not in shown
