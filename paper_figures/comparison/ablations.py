"""What each part of the controller is good for: the largest push on the trot with one part changed at a time."""

import pandas as pd
from matplotlib.figure import Figure

from paper_figures.push_limits import speeds_mps
from quadlab.analysis.artefact import Artefact, Claim, Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import COLUMN_WIDTH, NEUTRAL, SERIES, paper_style

STUDY = "ablations"
ARTEFACT = Artefact("X-S1 ablations", "comparison", "One part of the controller changed at a time", (STUDY,))
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
        axes.plot(single, [place] * len(single), "o", color=SERIES[0], markersize=2.2)
    axes.set_yticks(list(places), table["variant"])
    axes.invert_yaxis()
    axes.grid(visible=False, axis="y")
    axes.set_xlabel("largest push, J/m [m/s]; bar: median")
    return figure


def _speeds(results: StudyResults) -> pd.DataFrame:
    limits = results.limits(STUDY)
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
