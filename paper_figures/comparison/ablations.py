"""What each part of the controller is good for: the largest push and the highest plank with one part changed."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper_figures.known_limits import known_limits, limit_text
from paper_figures.push_limits import ANYMAL_KG, PUSH_S
from quadlab.analysis.artefact import Artefact, Claim, Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.geometry.rotations import Array
from quadlab.plotting.style import NEUTRAL, SERIES, TEXT_WIDTH, paper_style

STUDY = "ablations"
CAPTION = (
    "What a trot of ANYmal B survives: the largest push of 0.15 s to four sides, as J/m, and the highest plank that it "
    "does not know of, at three places; estimator ekf, planner vertex_zmp and controller hierarchical but for what is "
    "named. Bars: median of the cases, dotted line: that of the reference; dots: the cases, those with the same limit "
    "below each other. Pushes are searched on a grid of 20 N, 0.1 m/s, from 40 N on, planks on one of 1 cm from 2 cm: "
    "one step more or less is no difference, and 0 is that none of them was survived."
)
ARTEFACT = Artefact("X-S1 ablations", "comparison", "One part of the controller changed at a time", (STUDY,), CAPTION)
DOT_ROWS = 0.26
"""Distance of dots of equal value, in rows."""
REFERENCE = "reference"


@dataclass(frozen=True)
class Limit:
    """What is searched for.

    Attributes:
        disturbance: level of that factor.
        text: with its unit.
        scale: from the unit of the search.
        digits: behind the point.
    """

    disturbance: str
    text: str
    scale: float
    digits: int


LIMITS = (
    Limit("push", "largest push, J/m [m/s]", PUSH_S / ANYMAL_KG, 2),
    Limit("plank", "highest plank [cm]", 100.0, 0),
)


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return one bar a variant, the median over the cases, and the single cases as dots; one panel a disturbance."""
    table = numbers(results)
    variants = list(dict.fromkeys(table["variant"]))
    figure = Figure(figsize=(TEXT_WIDTH, 0.19 * len(variants) + 0.6), layout="constrained")
    panels = figure.subplots(1, len(LIMITS), sharey=True, squeeze=False)[0]
    for axes, limit in zip(panels, LIMITS, strict=True):
        _draw_limits(axes, limit, _limits(results, limit), variants)
    panels[0].set_yticks(range(len(variants)), variants)
    panels[0].invert_yaxis()
    return figure


def _draw_limits(axes: Axes, limit: Limit, limits: pd.DataFrame, variants: list[str]) -> None:
    reference = limits.loc[limits["variant"] == REFERENCE, "value"].median()
    axes.axvline(reference, color=SERIES[1], linewidth=0.8, linestyle=":")
    for place, name in enumerate(variants):
        single = limits.loc[limits["variant"] == name, "value"]
        axes.barh(place, single.median(), color=SERIES[1] if name == REFERENCE else NEUTRAL, height=0.65)
        axes.plot(single, place + stacked(single), "o", color=SERIES[0], markersize=2.2, clip_on=False)
    axes.grid(visible=False, axis="y")
    axes.set_xlabel(limit.text)


def stacked(values: "pd.Series[float]") -> Array:
    """Return by how much each dot moves across, in rows: equal values lie below each other and none is hidden."""
    rounded = values.round(3)
    rank = rounded.groupby(rounded).cumcount()
    count = rounded.groupby(rounded).transform("size")
    return np.asarray(DOT_ROWS * (rank - 0.5 * (count - 1)), dtype=float)


def _limits(results: StudyResults, limit: Limit) -> pd.DataFrame:
    """Return the searches of one disturbance, their limits as ``value``, 0 where the smallest is too much already."""
    limits = known_limits(results, STUDY, ["disturbance", "variant"])
    limits = limits[limits["disturbance"] == limit.disturbance]
    return limits.assign(value=limit.scale * limits["limit"].fillna(0.0))


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return minimum and median over the cases, one row a disturbance and variant, in the order of the study."""
    groups = [_limits(results, limit).groupby(["disturbance", "variant"], sort=False)["value"] for limit in LIMITS]
    tables = [group.agg(minimum="min", median="median", cases="count").reset_index() for group in groups]
    return pd.concat(tables, ignore_index=True)


def claims(results: StudyResults) -> list[Claim]:
    """Return one line a variant and disturbance."""
    table, unsolved = numbers(results), _unsolved(results)
    return [
        Claim(
            f"{row['variant']}: {limit.text}, trot, minimum / median",
            "-",
            f"{_both(row, limit.digits)} ({row['cases']} cases)",
            Verdict.NEW,
            unsolved.get(row["variant"], ""),
        )
        for limit in LIMITS
        for _, row in table[table["disturbance"] == limit.disturbance].iterrows()
    ]


def _both(row: "pd.Series[float]", digits: int) -> str:
    return f"{limit_text(row['minimum'], digits)} / {limit_text(row['median'], digits)}"


def _unsolved(results: StudyResults) -> dict[str, str]:
    """Return a sentence for each variant in whose median trial the solver did not always find a solution."""
    medians = results.table(STUDY).groupby("variant")["control_fallbacks"].median()
    return {
        str(name): f"Ticks without a solution, in which torques stay as they were: {ticks:.0f} in the median trial."
        for name, ticks in medians[medians >= 1.0].items()
    }
