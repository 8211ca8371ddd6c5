"""Comparisons pair equal conditions, count what has no partner, and say how sure they are."""

from pathlib import Path

import pandas as pd
import pytest
from trial_folders import begin, fail, finish

from quadlab.analysis.collect import collect_trials
from quadlab.analysis.comparison import grouped, paired
from quadlab.analysis.comparison_tables import success_table
from quadlab.analysis.factors import level_order, texts_of
from quadlab.analysis.statistics import wilson_interval
from quadlab.analysis.text_table import TextTable
from quadlab.cli import main
from quadlab.errors import LogError
from quadlab.trials.result import TrialStatus

METRIC = "com_error_rms_mm"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two controllers, four seeds, two gaits: the second is 0.5 mm worse, and falls once where the first does not."""
    results = tmp_path_factory.mktemp("results")
    for seed in range(4):
        for number, gait in enumerate(("trot", "pace")):
            error = 1.0 + seed + 10.0 * number
            finish(results, f"seed={seed}", f"gait={gait}", com_error_rms_mm=error)
            falls = (seed, gait) == (3, "pace")
            status = TrialStatus.FELL if falls else TrialStatus.COMPLETED
            finish(
                results,
                f"seed={seed}",
                f"gait={gait}",
                "controller=weighted",
                status=status,
                com_error_rms_mm=99.0 if falls else error + 0.5,
            )
    finish(results, "seed=9", "controller=weighted")
    return results


def test_groups_count_completed_trials_and_leave_the_metric_of_the_others_out(folder: Path) -> None:
    groups = {group.levels: group for group in grouped(collect_trials(folder), ["controller", "gait"], METRIC)}
    fallen = groups["weighted", "pace"]
    assert fallen.success == wilson_interval(3, 4)
    assert sorted(fallen.metric) == [11.5, 12.5, 13.5]
    assert groups["weighted", "trot"].success.count == 5


def test_pairs_are_trials_that_differ_in_the_factor_alone(folder: Path) -> None:
    (comparison,) = paired(collect_trials(folder), "controller", METRIC)
    assert (comparison.first, comparison.second) == ("hierarchical", "weighted")
    assert comparison.success.count == 8
    assert comparison.success.estimate == pytest.approx(-1 / 8)
    assert comparison.metric.count == 7
    assert comparison.metric.estimate == pytest.approx(0.5)
    assert comparison.metric.upper - comparison.metric.lower == pytest.approx(0.0, abs=1e-9)
    assert comparison.unpaired == 1


def test_a_key_of_the_configuration_is_a_factor_too(folder: Path) -> None:
    (by_key,) = paired(collect_trials(folder), "controller.kind", METRIC)
    (by_name,) = paired(collect_trials(folder), "controller", METRIC)
    assert by_key == by_name


def test_baseline_turns_the_sign(folder: Path) -> None:
    (comparison,) = paired(collect_trials(folder), "controller", METRIC, baseline="weighted")
    assert comparison.metric.estimate == pytest.approx(-0.5)


def test_seeds_that_differ_between_the_levels_make_no_pairs(tmp_path: Path) -> None:
    finish(tmp_path, "seed=1")
    finish(tmp_path, "seed=2", "controller=weighted")
    (comparison,) = paired(collect_trials(tmp_path), "controller", METRIC)
    assert comparison.success.count == 0
    assert comparison.unpaired == 2


@pytest.mark.parametrize(
    ("factor", "metric", "baseline", "message"),
    [
        ("controler", METRIC, None, "did you mean 'controller'"),
        ("controller.rate", METRIC, None, "or a dotted key, see the header of trials.csv"),
        ("scenario", METRIC, None, "scenario is '.*' in all trials, there is nothing to compare"),
        (METRIC, METRIC, None, "'com_error_rms_mm' is an outcome, no factor"),
        ("status", METRIC, None, "'status' is an outcome, no factor"),
        ("commit", METRIC, None, "'commit' is no factor"),
        ("controller", "com_error", None, "'com_error' is no outcome that is a number"),
        ("controller", "seed", None, "'seed' is no outcome that is a number"),
        ("controller", METRIC, "weigthed", "did you mean 'weighted'"),
    ],
)
def test_mistakes_name_what_exists(folder: Path, factor: str, metric: str, baseline: str | None, message: str) -> None:
    with pytest.raises(LogError, match=message) as raised:
        paired(collect_trials(folder), factor, metric, baseline)
    assert len(str(raised.value)) < 1000


def test_same_factor_twice_is_refused(folder: Path) -> None:
    with pytest.raises(LogError, match="'gait' is named twice"):
        grouped(collect_trials(folder), ["gait", "gait"], METRIC)


@pytest.fixture(scope="module")
def rates(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three rates and three seeds; the fastest stands for two more trials whose program failed."""
    results = tmp_path_factory.mktemp("rates")
    for rate in (80, 100, 400):
        for seed in (2, 10, 1):
            where = (f"controller.rate_hz={rate}", f"seed={seed}")
            (fail if rate == 400 and seed != 1 else finish)(results, *where)
    return results


def test_numbers_are_ordered_by_value_everywhere(rates: Path) -> None:
    table = collect_trials(rates)
    groups = grouped(table, ["seed", "controller.rate_hz"], METRIC)
    assert list(dict.fromkeys(group.levels[0] for group in groups)) == ["1", "2", "10"]
    shown = success_table(groups, ["seed", "controller.rate_hz"])
    assert shown.header[1:] == tuple(f"controller.rate_hz={rate}" for rate in ("80", "100", "400"))
    comparisons = paired(table, "controller.rate_hz", METRIC)
    assert [(one.first, one.second) for one in comparisons] == [("80", "100"), ("80", "400")]


@pytest.mark.parametrize("baseline", ["100", "100.0", "1e2"])
def test_baseline_may_be_written_as_any_equal_number(rates: Path, baseline: str) -> None:
    comparisons = paired(collect_trials(rates), "controller.rate_hz", METRIC, baseline)
    assert [comparison.first for comparison in comparisons] == ["100", "100"]


def test_unlike_numbers_are_unlike_levels() -> None:
    values = [0.1, 0.1 + 1e-15, 400.0, 1e-7, 1000000.0, None]
    words = list(texts_of(pd.Series(values, dtype="Float64")))
    assert words[0] == "0.1"
    assert words[2:] == ["400", "1e-07", "1000000", "none"]
    assert len(set(words)) == len(values)
    assert sorted(words, key=level_order)[-2:] == ["1000000", "none"]


def test_errors_of_the_program_are_no_failures_of_the_controller(rates: Path) -> None:
    *_, fastest = grouped(collect_trials(rates), ["controller.rate_hz"], METRIC)
    assert (fastest.levels, fastest.success, fastest.errors) == (("400",), wilson_interval(1, 1), 2)
    *_, comparison = paired(collect_trials(rates), "controller.rate_hz", METRIC)
    assert comparison.success.estimate == 0.0
    assert (comparison.success.count, comparison.unpaired) == (1, 2)
    assert success_table([fastest], ["x"]).rows == (("400", "1 of 1 (21 to 100 %), 2 errors"),)


def test_level_in_which_every_program_failed_is_shown_and_drawn(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    finish(tmp_path, "seed=1")
    fail(tmp_path, "seed=1", "controller=weighted")
    assert main(["compare", str(tmp_path), "--by", "controller", "--baseline", "weighted"]) == 0
    shown = capsys.readouterr().out
    assert "| weighted | -, 1 error |" in shown
    assert "| hierarchical | weighted | - | 0 | - | 0 | 1 |" in shown
    assert "\n1 ended in an error.\n" in shown
    assert (tmp_path / f"compare/{METRIC}_by_controller_from_weighted.md").is_file()


def test_what_is_left_out_and_pooled_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    finish(tmp_path, "seed=1")
    finish(tmp_path, "seed=1", "controller=weighted", commit="d" * 40)
    begin(tmp_path, "seed=2")
    for command in (["collect"], ["compare", "--by", "controller"]):
        assert main([command[0], str(tmp_path), *command[1:]]) == 0
        shown = capsys.readouterr().out
        assert "1 half-written left out" in shown
        assert "trials of 2 commits: cccccccccc, dddddddddd" in shown


def test_missing_configuration_costs_its_own_pair_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for seed in range(3):
        finish(tmp_path, f"seed={seed}")
        last = finish(tmp_path, f"seed={seed}", "controller=weighted")
    columns = len(collect_trials(tmp_path).columns)
    (last / "config.yaml").unlink()
    assert len(collect_trials(tmp_path).columns) == columns
    assert main(["compare", str(tmp_path), "--by", "controller"]) == 0
    shown = capsys.readouterr().out
    assert "| weighted | hierarchical | +0 % (" in shown
    assert "| 2 | +0 (+0 to +0) | 2 | 1 |" in shown
    assert f"no config.yaml that can be read, left out of comparisons: {last.name}" in shown


def test_files_of_a_comparison(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", str(folder), "--by", "controller", "--columns", "gait"]) == 0
    shown = capsys.readouterr().out
    assert "| completed: controller | gait=pace | gait=trot |" in shown
    assert "| weighted | 3 of 4 (30 to 95 %) | 5 of 5 (57 to 100 %) |" in shown
    target = folder / "compare"
    assert {path.suffix for path in target.iterdir()} == {".md", ".tex", ".png", ".pdf"}
    tex = (target / f"{METRIC}_by_controller_by_gait.tex").read_text()
    assert r"weighted & 3 of 4 (30 to 95 \%) & 5 of 5 (57 to 100 \%) \\" in tex
    assert r"com\_error\_rms\_mm" in tex


def test_latex_special_characters_are_escaped() -> None:
    table = TextTable(("a_b", "50 %"), (("x & y", "#1"), ("|", "$2")), labels=1)
    assert r"x \& y & \#1 \\" in table.latex()
    assert r"a\_b & 50 \% \\" in table.latex()
    assert r"| \| | $2 |" in table.markdown()
    assert r"\textbar{} & \$2 \\" in table.latex()
    assert r"\textless{}b\textgreater{}" in TextTable(("<b>",), (), labels=1).latex()


@pytest.mark.parametrize(
    ("cell", "shown"),
    [
        ("-0.3 (-0.4 to +0.1)", "$-$0.3 ($-$0.4 to +0.1)"),
        ("-1e-05", "$-$1e$-$05"),
        ("x=-5", "x=$-$5"),
        ("push-3 and a-b", "push-3 and a-b"),
        ("-", "-"),
    ],
)
def test_latex_minus_is_a_minus_and_a_hyphen_stays_one(cell: str, shown: str) -> None:
    assert rf"{shown} \\" in TextTable(("a",), ((cell,),), labels=1).latex()
