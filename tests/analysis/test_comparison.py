"""Comparisons pair equal conditions, count what has no partner, and say how sure they are."""

from pathlib import Path

import pytest
from trial_folders import finish

from quadlab.analysis.collect import collect_trials
from quadlab.analysis.comparison import grouped, paired
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
        ("controller", "com_error", None, "'com_error' is no numerical column"),
        ("controller", METRIC, "weigthed", "did you mean 'weighted'"),
    ],
)
def test_mistakes_name_what_exists(folder: Path, factor: str, metric: str, baseline: str | None, message: str) -> None:
    with pytest.raises(LogError, match=message):
        paired(collect_trials(folder), factor, metric, baseline)


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
