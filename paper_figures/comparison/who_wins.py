"""Weighted or hierarchical, kinematic or vertex ZMP: differences over pairs with the same everything else."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper_figures.comparison_variants import FACTORS, STUDY, artefact
from paper_figures.known_limits import known_limits
from paper_figures.push_limits import ANYMAL_KG, PUSH_S
from quadlab.analysis.artefact import Claim, Verdict
from quadlab.analysis.paired import mean_difference
from quadlab.analysis.statistics import Interval
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import TEXT_WIDTH, paper_style

CAPTION = (
    "Mean differences over conditions (disturbance, gait, seed, or direction and place of a search for a limit), each "
    "the mean over both levels of the other factor, with intervals of 95 % that are not corrected for their number; "
    "estimator ekf. Blue: the first is better, orange: the second, grey: not clear."
)
ARTEFACT = artefact("differences", "Weighted or hierarchical, kinematic or vertex ZMP", CAPTION)


@dataclass(frozen=True)
class Measure:
    """Something in which variants are compared.

    Attributes:
        name: with its unit.
        column: of the table.
        larger_is_better: direction.
        scale: from the column's unit.
        disturbance: rows that count; all if empty.
        by_gait: whether each gait stands for itself, since gaits differ in it.
        searched: whether it is a limit that was searched for.
    """

    name: str
    column: str
    larger_is_better: bool
    scale: float = 1.0
    disturbance: str = ""
    by_gait: bool = False
    searched: bool = False


COMPLETED = "completed"
"""Column of 1 for trials that stayed up and 0 for others."""
MEASURES = (
    Measure("completed trials [share]", COMPLETED, True),
    Measure("largest push [m/s]", "limit", True, PUSH_S / ANYMAL_KG, "push", searched=True),
    Measure("highest plank [cm]", "limit", True, 100.0, "plank", searched=True),
    Measure("deepest step down [cm]", "limit", True, 100.0, "step down", searched=True),
    Measure("largest CoM error [mm]", "com_error_max_mm", False, by_gait=True),
    Measure("roll and pitch, rms [deg]", "roll_pitch_rms_deg", False),
    Measure("cost of transport [-]", "cost_of_transport", False, by_gait=True),
    Measure("planning [ms]", "planning_solve_ms", False),
    Measure("control tick, median [us]", "control_tick_median_us", False),
)
KEYS = ("disturbance", "gait", "direction", "scenario.pushes.0.start_s", "scenario.terrain.0.center_x_m",
        "scenario.terrain.0.edge_x_m", "seed")  # fmt: skip


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return differences with their 95 % intervals, one panel a measure and one column a question."""
    table = numbers(results)
    names = list(dict.fromkeys(table["measure"]))
    figure = Figure(figsize=(TEXT_WIDTH, 0.36 * len(names) + 1.1), layout="constrained")
    panels = figure.subplots(len(names), len(FACTORS), squeeze=False)
    for column, (factor, (first, second)) in enumerate(FACTORS.items()):
        panels[0, column].set_title(f"{second} minus {first}")
        for row, name in enumerate(names):
            entry = table[(table["factor"] == factor) & (table["measure"] == name)]
            _draw_difference(panels[row, column], entry.iloc[0], label=column == 0)
    meaning = "mean difference with 95 % interval; blue: the first is better, orange: the second, grey: not clear"
    figure.supxlabel(meaning, fontsize=rcParams["axes.labelsize"])
    return figure


def _draw_difference(axes: Axes, entry: "pd.Series[float]", *, label: bool) -> None:
    estimate, lower, upper = (float(entry[name]) for name in ("difference", "lower", "upper"))
    clear = lower > 0.0 or upper < 0.0
    better = clear and ((estimate > 0.0) == bool(entry["larger_is_better"]))
    colour = "#7f7f7f" if not clear else "#0072b2" if better else "#d55e00"
    axes.errorbar([estimate], [0.0], xerr=[[estimate - lower], [upper - estimate]], fmt="o", color=colour, capsize=2)
    axes.axvline(0.0, color="#1a1a1a", linewidth=0.6)
    reach = 1.15 * max(abs(lower), abs(upper), 1e-9)
    axes.set_xlim(-reach, reach)
    axes.set_yticks([0.0], [str(entry["measure"])] if label else [""])
    axes.tick_params(axis="y", length=0.0)
    axes.grid(visible=False, axis="y")
    axes.spines["left"].set_visible(False)
    axes.locator_params(axis="x", nbins=5)
    axes.ticklabel_format(axis="x", style="plain", useOffset=False)


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return one row a question and measure: mean of both, difference and its 95 % interval."""
    return pd.DataFrame(list(_rows(results.table(STUDY), known_limits(results, STUDY))))


def _rows(table: pd.DataFrame, limits: pd.DataFrame) -> Iterator[dict[str, object]]:
    tracked = table[~table["disturbance"].isin(limits["disturbance"].unique())]
    tracked = tracked.assign(**{COMPLETED: (tracked["status"] == "completed").astype(float)})
    good, survived = tracked[tracked[COMPLETED] > 0.0], limits.fillna({"limit": 0.0})
    for factor, levels in FACTORS.items():
        for measure in MEASURES:
            source = survived if measure.searched else tracked if measure.column == COMPLETED else good
            for name, rows in _parts(source, measure):
                scaled = rows.assign(**{measure.column: measure.scale * rows[measure.column]})
                means, same = averaged(scaled, factor, measure.column)
                difference = mean_difference(means, factor, levels, same, measure.column)
                yield _row(factor, name, measure.larger_is_better, difference)


def _parts(source: pd.DataFrame, measure: Measure) -> Iterator[tuple[str, pd.DataFrame]]:
    """Return the rows that count for a measure, gait by gait if gaits stand for themselves, and how that is called."""
    chosen = source[source["disturbance"] == measure.disturbance] if measure.disturbance else source
    if not measure.by_gait:
        yield measure.name, chosen
        return
    for gait, rows in chosen.groupby("gait", sort=False):
        yield f"{measure.name}, {str(gait).replace('_', ' ')}", rows


def averaged(table: pd.DataFrame, factor: str, column: str) -> tuple[pd.DataFrame, list[str]]:
    """Return the mean of ``column`` over the levels of the other factor, and the columns that make a condition.

    There is one row a condition and level of ``factor``.

    Trials that differ in the other factor alone are no independent ones: counted singly they would make intervals too
    narrow. Conditions in which a value is missing at one of its levels are left out.
    """
    other = next(name for name in FACTORS if name != factor)
    keys = [key for key in KEYS if key in table]
    known = table.assign(**{key: table[key].astype(str).where(table[key].notna(), "") for key in keys})
    groups = known.groupby([*keys, factor], observed=True)[column]
    means = groups.agg(["mean", "count"]).reset_index().rename(columns={"mean": column})
    return means[means["count"] == len(FACTORS[other])], keys


def _row(factor: str, name: str, larger_is_better: bool, difference: Interval) -> dict[str, object]:
    return {
        "factor": factor,
        "measure": name,
        "difference": difference.estimate,
        "lower": difference.lower,
        "upper": difference.upper,
        "pairs": difference.count,
        "larger_is_better": larger_is_better,
    }


def claims(results: StudyResults) -> list[Claim]:
    """Return one line a question and measure: who is better, if anyone."""
    return [_claim(row) for _, row in numbers(results).iterrows()]


def _claim(row: "pd.Series[float]") -> Claim:
    first, second = FACTORS[str(row["factor"])]
    lower, upper, estimate = float(row["lower"]), float(row["upper"]), float(row["difference"])
    values = f"{estimate:+.3g} ({lower:+.3g} to {upper:+.3g}), {row['pairs']} pairs"
    if not (np.isfinite(lower) and (lower > 0.0 or upper < 0.0)):
        return Claim(f"{row['measure']}: {second} minus {first}", "-", values, Verdict.NEW, "No clear difference.")
    better = second if (estimate > 0.0) == bool(row["larger_is_better"]) else first
    return Claim(f"{row['measure']}: {second} minus {first}", "-", values, Verdict.NEW, f"{better} is better.")
