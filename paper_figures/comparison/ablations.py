"""What each part of the controller is good for: the largest push on the trot with one part changed at a time."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from paper_figures.known_limits import known_limits
from paper_figures.push_limits import speeds_mps
from quadlab.analysis.artefact import Artefact, Claim, Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.geometry.rotations import Array
from quadlab.plotting.style import COLUMN_WIDTH, NEUTRAL, SERIES, paper_style

STUDY = "ablations"
CAPTION = (
    "Largest sideways, forward or backward push of 0.15 s that a trot of ANYmal B survives, as J/m; estimator "
    "ekf, planner vertex_zmp and controller hierarchical but for what is named. Bars: median of four cases; dots: "
    "the cases, those with the same limit below each other."
)
ARTEFACT = Artefact("X-S1 ablations", "comparison", "One part of the controller changed at a time", (STUDY,), CAPTION)
DOT_ROWS = 0.26
"""Distance of dots of equal value, in rows."""
REFERENCE = "reference"


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return one bar a variant, the median over the cases, and the single cases as dots."""
    limits = _speeds(results)
    table = numbers(results)
    figure = Figure(figsize=(COLUMN_WIDTH, 0.19 * len(table) + 0.6), layout="constrained")
    axes = figure.subplots()
    places = range(len(table))
    colours = [SERIES[1] if name == REFERENCE else NEUTRAL for name in table["variant"]]
    axes.barh(places, table["median_mps"], color=colours, height=0.65)
    for place, name in zip(places, table["variant"], strict=True):
        single = limits.loc[limits["variant"] == name, "mps"]
        axes.plot(single, place + stacked(single), "o", color=SERIES[0], markersize=2.2, clip_on=False)
    axes.set_yticks(list(places), table["variant"])
    axes.invert_yaxis()
    axes.grid(visible=False, axis="y")
    axes.set_xlabel("largest push, J/m [m/s]; bar: median")
    return figure


def stacked(values: "pd.Series[float]") -> Array:
    """Return by how much each dot moves across, in rows, so that equal values lie side by side and none is hidden."""
    rounded = values.round(3)
    rank = rounded.groupby(rounded).cumcount()
    count = rounded.groupby(rounded).transform("size")
    return np.asarray(DOT_ROWS * (rank - 0.5 * (count - 1)), dtype=float)


def _speeds(results: StudyResults) -> pd.DataFrame:
    limits = known_limits(results, STUDY)
    return limits.assign(mps=speeds_mps(limits))


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return minimum and median over the cases, one row a variant, in the order of the study."""
    groups = _speeds(results).groupby("variant", sort=False)["mps"]
    return groups.agg(minimum_mps="min", median_mps="median", cases="count").reset_index()


def claims(results: StudyResults) -> list[Claim]:
    """Return one line a variant."""
    return [
        Claim(
            f"{row['variant']}: push survived on the trot, minimum / median [m/s]",
            "-",
            f"{row['minimum_mps']:.2f} / {row['median_mps']:.2f} ({row['cases']} cases)",
            Verdict.NEW,
        )
        for _, row in numbers(results).iterrows()
    ]
