"""Bellicoso 2016, Eq. (22)-(24): the height of the base that emerges from the manipulability of the legs."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper_figures.trial_claims import survival
from quadlab.analysis.artefact import Artefact, Claim, Verdict, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import COLUMN_WIDTH, NEUTRAL, SERIES, paper_style
from quadlab.robots.catalogue import robot_config

STUDY = "bellicoso2016_manipulability"
CAPTION = (
    "Standing and walking with the base height left to the manipulability of the legs, ANYmal B, estimator ekf, "
    "seed 0. Heights are those of the simulated base. (a) From a high, the nominal and a low stance. (b) The same "
    "trials, manipulability over height; dots: ends. (c) A walk, beside the same walk at constant height."
)
ARTEFACT = Artefact("B-X1", "Bellicoso 2016, Eq. 22-24", "Body height emerging from manipulability", (STUDY,), CAPTION)
STARTS = {"high": SERIES[2], "nominal": SERIES[0], "low": SERIES[1]}
HEIGHTS = {"manipulability": SERIES[3], "constant": NEUTRAL}
BEST_SHARE, PARTLY_SHARE = 0.99, 0.9
"""Of the largest manipulability passed on the way, from which on a height counts as the best, or as partly."""


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return height over time from three stances, manipulability over height, and height over a walk."""
    table = numbers(results)
    figure = Figure(figsize=(COLUMN_WIDTH, 4.4), layout="constrained")
    for_stand, for_measure, for_walk = figure.subplots(3, 1)
    for start, colour in STARTS.items():
        rows = table[table["trial"] == f"stand_{start}"]
        for_stand.plot(rows["time_s"], rows["height_m"], color=colour, label=start)
        for_measure.plot(rows["height_m"], 1e3 * rows["manipulability_m3"], color=colour)
        for_measure.plot(rows["height_m"].iloc[-1:], 1e3 * rows["manipulability_m3"].iloc[-1:], "o", color=colour, ms=4)
    for height, colour in HEIGHTS.items():
        rows = table[table["trial"] == f"walk_{height}"]
        for_walk.plot(rows["time_s"], rows["height_m"], color=colour, label=height)
    _label(for_stand, "time [s]", "base height [m]", "(a) standing, from three stances")
    _label(for_measure, "base height [m]", "manipulability [dm³]", "(b) mean of the legs; dots: where it ends")
    _label(for_walk, "time [s]", "base height [m]", "(c) walking, height from")
    for_stand.legend(loc="lower right", ncols=3)
    for_walk.legend(loc="upper right", ncols=2, bbox_to_anchor=(1.0, 1.2))
    figure.align_ylabels()
    return figure


def _label(axes: Axes, across: str, up: str, title: str) -> None:
    axes.set(xlabel=across, ylabel=up)
    axes.set_title(title, loc="left")
    axes.margins(x=0.02, y=0.12)


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return true height of the base and mean manipulability of the legs over time, one block a kept trial."""
    names = [*(f"stand_{start}" for start in STARTS), *(f"walk_{height}" for height in HEIGHTS)]
    return pd.concat([_curves(results, name) for name in names], ignore_index=True)


def _curves(results: StudyResults, name: str) -> pd.DataFrame:
    from quadlab.analysis.manipulability import mean_manipulability  # noqa: PLC0415 - loads the robot's physics
    from quadlab.robots.model import load_robot  # noqa: PLC0415

    trace = results.trace(STUDY, name)
    return pd.DataFrame(
        {
            "trial": name,
            "time_s": trace.index,
            "height_m": trace["state.base_position_z"].to_numpy(),
            "manipulability_m3": mean_manipulability(load_robot(robot_config("anymal_b")), trace),
        }
    )


def claims(results: StudyResults) -> list[Claim]:
    """Return where the height ends, how good it is there, and whether the robot stays up and walks with it."""
    table, curves = results.table(STUDY), numbers(results)
    emerging = table[table["height"] == "manipulability"]
    standing, walking = (emerging[emerging["motion"] == motion] for motion in ("stand", "walk"))
    return [
        survival("stands with an emerging height from three stances, ekf and truth", standing, "not printed"),
        _same_height(curves),
        _best_height(curves),
        survival("walks with an emerging height, ekf and truth", walking, "not printed"),
        _walk_gain(curves),
    ]


def _same_height(curves: pd.DataFrame) -> Claim:
    """Return how far apart the heights from three stances end; no paper says it."""
    trials = [curves.loc[curves["trial"] == f"stand_{start}", "height_m"] for start in STARTS]
    first, last = (np.array([float(heights.iloc[place]) for heights in trials]) for place in (0, -1))
    apart = f"{1e3 * np.ptp(last):.2g} mm apart at {last.mean():.3f} m, {1e3 * np.ptp(first):.0f} mm apart before"
    text = "the height is the same from a low, the nominal and a high stance"
    return Claim(text, "not printed", apart, Verdict.NEW)


def _best_height(curves: pd.DataFrame) -> Claim:
    """Return the claim that the height is that of the best manipulability."""
    standing = curves[curves["trial"].str.startswith("stand_")]
    measure, height = standing["manipulability_m3"].to_numpy(), standing["height_m"].to_numpy()
    last, best = ~standing.duplicated("trial", keep="last").to_numpy(), int(np.argmax(measure))
    share = float(measure[last].min() / measure[best])
    off_mm = 1e3 * float(np.abs(height[last] - height[best]).max())
    holds = share >= BEST_SHARE
    return Claim(
        "there the legs have the best manipulability", "knee singularities are avoided",
        f"{100 * share:.1f} % of the largest on the way, at most {off_mm:.1f} mm off its height",
        verdict(holds=holds, partly=share >= PARTLY_SHARE),
        "" if holds else "Eq. (23) looks at the knees alone; a base on standing feet turns the thighs as well.",
    )  # fmt: skip


def _walk_gain(curves: pd.DataFrame) -> Claim:
    """Return how the manipulability of the walk differs from that at a constant height; no paper says it."""
    emerging, constant = (curves.loc[curves["trial"] == f"walk_{height}", "manipulability_m3"] for height in HEIGHTS)
    change = 100.0 * (float(emerging.mean()) / float(constant.mean()) - 1.0)
    text = "mean manipulability of the walk against the one at the constant nominal height"
    return Claim(text, "not printed", f"{change:+.1f} %", Verdict.NEW)
