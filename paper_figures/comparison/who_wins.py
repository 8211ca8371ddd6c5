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
from quadlab.analysis.paired import mean_difference, share_difference
from quadlab.analysis.statistics import Interval
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import TEXT_WIDTH, paper_style

CAPTION = (
    "Mean differences over pairs of trials, or of searches for a limit, that differ in nothing else, with "
    "intervals of 95 %; estimator ekf. Blue: the first is better, orange: the second, grey: not clear."
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
        searched: whether it is a limit that was searched for.
    """

    name: str
    column: str
    larger_is_better: bool
    scale: float = 1.0
    disturbance: str = ""
    searched: bool = False


MEASURES = (
    Measure("largest push [m/s]", "limit", True, PUSH_S / ANYMAL_KG, "push", True),
    Measure("highest plank [cm]", "limit", True, 100.0, "plank", True),
    Measure("deepest step down [cm]", "limit", True, 100.0, "step down", True),
    Measure("largest CoM error [mm]", "com_error_max_mm", False),
    Measure("roll and pitch, rms [deg]", "roll_pitch_rms_deg", False),
    Measure("cost of transport [-]", "cost_of_transport", False),
    Measure("planning [ms]", "planning_solve_ms", False),
    Measure("control tick, median [us]", "control_tick_median_us", False),
)
SUCCESS = "completed trials [share]"
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


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return one row a question and measure: mean of both, difference and its 95 % interval."""
    return pd.DataFrame(list(_rows(results.table(STUDY), known_limits(results, STUDY))))


def _rows(table: pd.DataFrame, limits: pd.DataFrame) -> Iterator[dict[str, object]]:
    tracked = table[~table["disturbance"].isin(limits["disturbance"].unique())]
    for factor, levels in FACTORS.items():
        other = next(name for name in FACTORS if name != factor)
        same = [key for key in (*KEYS, other) if key in tracked]
        yield _row(factor, SUCCESS, True, share_difference(tracked, factor, levels, same, ["completed"]))
        completed = tracked[tracked["status"] == "completed"]
        for measure in MEASURES:
            source = limits.fillna({"limit": 0.0}) if measure.searched else completed
            chosen = source[source["disturbance"] == measure.disturbance] if measure.disturbance else source
            scaled = chosen.assign(**{measure.column: measure.scale * chosen[measure.column]})
            same = [key for key in (*KEYS, other) if key in scaled]
            difference = mean_difference(scaled, factor, levels, same, measure.column)
            yield _row(factor, measure.name, measure.larger_is_better, difference)


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
