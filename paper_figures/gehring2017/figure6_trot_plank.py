"""Gehring 2017, Fig. 6: a trot over a plank that nobody announced, under the front legs."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from paper_figures.known_limits import known_limits
from paper_figures.trial_claims import paper_stack, survival, variant_claims
from quadlab.analysis.artefact import Artefact, Claim, Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import COLUMN_WIDTH, MEASURED, REFERENCE, SERIES, paper_style
from quadlab.robots.legs import LEGS

STUDY = "gehring2017_trot_plank"
CAPTION = (
    "Trot, 0.8 s and 0.25 m a stride, over a plank 8 cm high and 20 cm deep with its middle at x = 0.65 m; our "
    "priorities, estimator ekf, seed 0, nominal start. Wide blue: desired, for feet while they swing; dashed: "
    "measured; dotted: height of the plank."
)
ARTEFACT = Artefact("G-F6", "Gehring 2017, Fig. 6", "Trot over an unperceived plank", (STUDY,), CAPTION)
HEIGHT, PLACE = "scenario.terrain.0.height_m", "scenario.terrain.0.center_x_m"
LEG_LENGTH_M = 0.564
"""Thigh and shank of ANYmal B."""
PLANK = SERIES[2]
RECOVERS = "recovers; height not printed"
NEEDED = {0.08: 10, 0.10: 8}
"""How many of ten places count as good, by height in [m]."""


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return pitch with its reference, and the heights of the front feet with theirs, over time."""
    table = numbers(results)
    figure = Figure(figsize=(COLUMN_WIDTH, 3.4), layout="constrained")
    for_pitch, *for_feet = figure.subplots(3, 1, sharex=True)
    for_feet[1].sharey(for_feet[0])
    for_pitch.plot(table["time_s"], table["pitch_reference_deg"], color=REFERENCE, linewidth=2.0, label="desired")
    for_pitch.plot(table["time_s"], table["pitch_deg"], "--", color=MEASURED, label="measured")
    for_pitch.set_ylabel("pitch [deg]")
    for axes, leg in zip(for_feet, ("LF", "RF"), strict=True):
        axes.plot(table["time_s"], table[f"{leg}_z_reference_m"], color=REFERENCE, linewidth=2.0)
        axes.plot(table["time_s"], table[f"{leg}_z_m"], "--", color=MEASURED)
        axes.axhline(0.08, color=PLANK, linestyle=":", label="height of the plank")
        axes.set_ylabel(f"{leg} height [m]")
    handles = [*for_pitch.get_legend_handles_labels()[0], *for_feet[0].get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles))
    for_feet[-1].set_xlabel("time [s]")
    figure.align_ylabels()
    return figure


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return pitch and heights of the feet, and their references, over time."""
    trace = results.trace(STUDY, "plank")
    angles = {
        "pitch_deg": np.degrees(trace["control.base_pitch"].to_numpy()),
        "pitch_reference_deg": np.degrees(trace["control.base_reference_pitch"].to_numpy()),
    }
    heights = {f"{leg}_z_m": trace[f"control.foot_position_{leg}_z"].to_numpy() for leg in LEGS}
    references = {f"{leg}_z_reference_m": trace[f"control.foot_position_reference_{leg}_z"].to_numpy() for leg in LEGS}
    return pd.DataFrame({"time_s": trace.index.to_numpy(), **angles, **heights, **references})


def claims(results: StudyResults) -> list[Claim]:
    """Return which heights are passed at how many places, the highest, and what holds the robot up."""
    table, limits = results.table(STUDY), known_limits(results, STUDY)
    reference = table[table["variant"] == "reference"]
    heights = [
        survival(
            f"trots over a plank of {100 * height:.0f} cm with our priorities, {estimator}",
            reference[np.isclose(reference[HEIGHT], height) & (reference["estimator"] == estimator)],
            RECOVERS,
            needed,
            "The arc of the swing is 12 cm high; falls were not diagnosed place by place.",
        )
        for height, needed in NEEDED.items()
        for estimator in ("ekf", "truth")
    ]
    highest = 100.0 * limits["limit"].fillna(0.0)
    share = 100.0 * highest.min() / (100.0 * LEG_LENGTH_M)
    ours = f"{highest.min():.0f} cm ({share:.0f} % of the leg), up to {highest.max():.0f} cm, {len(highest)} places"
    same = table[np.isclose(table[HEIGHT], 0.08) & table[PLACE].isin([0.55, 0.60, 0.65, 0.70, 0.75])]
    return [
        *heights,
        paper_stack(same, RECOVERS, "trots over a plank of 8 cm"),
        Claim("highest plank that is passed at every place tried, ekf", "not printed", ours, Verdict.NEW),
        *variant_claims(same, "8 cm"),
    ]
