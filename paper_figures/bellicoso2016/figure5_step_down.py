"""Bellicoso 2016, Fig. 5 and 6: a walk down a 14 cm step that nobody announced, with and without limb limits."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import imread

from paper_figures.limb_extensions import extension_limit, limb_extensions
from paper_figures.step_down_claims import (
    EDGE_M,
    SWINGS_UP,
    adaptation,
    lowers_at_the_limit,
    stays_low,
    stretched,
    tilts_at_the_limit,
)
from paper_figures.trial_claims import LEG_LENGTH_M, completed, survival
from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.geometry.rotations import Array
from quadlab.plotting.style import LEG_COLOURS, MEASURED, REFERENCE, SERIES, TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEGS
from quadlab.studies.config import load_study

STUDY = "bellicoso2016_step_down"
CAPTION = (
    f"Walk, 0.25 m a stride, down a 14 cm step at x = {EDGE_M:g} m with the priorities of the paper; estimator ekf, "
    "seed 0, nominal start. Left and pictures: with limb limits; right: without, until it falls at the end of the "
    "curves, curves cut off there. Wide blue: desired; dashed: measured; dotted: limit of the height of a hip over its "
    "foot. Here LF descends first, in the paper RF. Settings of this scenario: apex of the swing 0.19 of the standing "
    "height, search begins at 0.8 of the swing with 0.5 m/s, the plan waits meanwhile, the desired torso stays level."
)
ARTEFACT = Artefact("B-F56", "Bellicoso 2016, Fig. 5 and 6", "An unperceived step down of 14 cm", (STUDY,), CAPTION)
TRACES = {"with limb limits": "with_limits", "without limb limits": "without_limits"}
PICTURES = 6
LABELS = ("base height [m]", "angle [deg]", "hip over foot [m]", "foot height [m]")
NEEDED = 8
"""How many of ten places count as good."""
STEP_M = 0.14
PAPER_SHARE = 23
"""Of the longest leg, in [%], as printed."""


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return pictures of the descent above base height, angles, limb extension and foot heights over time."""
    figure = Figure(figsize=(TEXT_WIDTH, 6.6), layout="constrained")
    pictures, curves = np.asarray(figure.subfigures(2, 1, height_ratios=(1.0, 4.2))).tolist()
    _draw_pictures(pictures.subplots(1, PICTURES), results)
    panels = curves.subplots(4, 2, sharex=True, sharey="row")
    for column, (name, trace) in zip(panels.T, TRACES.items(), strict=True):
        _draw_trial(column, results.trace(STUDY, trace))
        column[0].set_title(name, loc="left")
        column[-1].set_xlabel("time [s]")
    for axes, label in zip(panels[:, 0], LABELS, strict=True):
        axes.set_ylabel(label)
    for axes in panels[:, 1]:  # that trial ends early: there is room
        axes.legend(loc="lower right")
    curves.align_ylabels(panels[:, 0])
    return figure


def _draw_pictures(panels: "np.ndarray[tuple[int], np.dtype[np.object_]]", results: StudyResults) -> None:
    found = results.snapshots(STUDY, "with_limits")
    times = next(trace.snapshots_s for trace in load_study(STUDY).traces if trace.name == "with_limits")
    chosen = np.linspace(0, len(found) - 1, PICTURES).round().astype(int)
    for axes, place in zip(panels, chosen, strict=True):
        picture = imread(found[place])
        width = picture.shape[1]
        axes.imshow(picture[:, int(0.1 * width) : int(0.9 * width)])
        axes.text(0.04, 0.04, f"{times[place]:g} s", transform=axes.transAxes, fontsize=6.5)
        axes.set_axis_off()


def _draw_trial(panels: "np.ndarray[tuple[int], np.dtype[np.object_]]", trace: pd.DataFrame) -> None:
    for_height, for_angles, for_limbs, for_feet = panels
    times = trace.index.to_numpy()
    _draw_desired(for_height, times, trace["control.base_height_reference"])
    for_height.plot(times, trace["state.base_position_z"], "--", color=MEASURED, label="measured")
    _draw_desired(for_angles, times, np.degrees(trace["control.base_reference_pitch"]))
    for name, colour in (("pitch", SERIES[2]), ("roll", SERIES[3])):
        for_angles.plot(times, np.degrees(trace[f"control.base_{name}"]), "--", color=colour, label=name)
    for_height.set_ylim(0.33, 0.57)
    for_angles.set_ylim(-16.0, 16.0)
    for leg, colour, extension in zip(LEGS, LEG_COLOURS, limb_extensions(trace).T, strict=True):
        for_limbs.plot(times, extension, color=colour, label=leg)
        for_feet.plot(times, trace[f"control.foot_position_{leg}_z"], color=colour, label=leg)
    for_limbs.axhline(extension_limit("bellicoso2016"), color=MEASURED, linestyle=":", label="limit")
    for_limbs.set_ylim(0.1, 0.62)
    for_feet.set_ylim(-0.2, 0.47)


def _draw_desired(axes: Axes, times: Array, values: "pd.Series[float]") -> None:
    axes.plot(times, values, color=REFERENCE, linewidth=2.0, label="desired")


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return height, angles, limb extensions and foot heights over time, one block a trial."""
    return pd.concat([_curves(results, name) for name in (*TRACES.values(), "with_limits_truth")], ignore_index=True)


def _curves(results: StudyResults, name: str) -> pd.DataFrame:
    trace = results.trace(STUDY, name)
    angles = {f"{key}_deg": np.degrees(np.asarray(trace[f"control.base_{key}"])) for key in ("pitch", "roll")}
    feet = {f"{leg}_z_m": np.asarray(trace[f"control.foot_position_{leg}_z"]) for leg in LEGS}
    limbs = dict(zip([f"{leg}_extension_m" for leg in LEGS], limb_extensions(trace).T, strict=True))
    height = {"base_z_m": np.asarray(trace["state.base_position_z"])}
    return pd.DataFrame({"trial": name, "time_s": trace.index.to_numpy(), **height, **angles, **feet, **limbs})


def claims(results: StudyResults) -> list[Claim]:
    """Return at how many places the step is passed, with and without limb limits, and how torso and limbs move."""
    table, curves = results.table(STUDY), numbers(results)
    groups = dict(list(table.groupby(["limits", "estimator"])))
    step = f"{100 * STEP_M:.0f} cm ({100 * STEP_M / LEG_LENGTH_M:.0f} % of thigh and shank)"
    paper = f"succeeds, {PAPER_SHARE} % of the longest leg"
    slips = "Where it falls, a foot has touched the edge itself, slips off it and is searched for too late."
    good = [
        survival(f"walks down {step} with limb limits, {name}", groups[limits, estimator], paper, NEEDED, slips)
        for name, limits, estimator in (
            ("ekf", "with", "ekf"),
            ("truth", "with", "truth"),
            ("torso in the control frame, ekf", "with in control frame", "ekf"),
        )
    ]
    adapted = curves[curves["trial"] == "with_limits"]
    without, limit = results.trace(STUDY, "without_limits"), extension_limit("bellicoso2016")
    moves = [adaptation(adapted, STEP_M), tilts_at_the_limit(adapted, limit), lowers_at_the_limit(adapted, limit)]
    return [*good, _ablation(groups["without", "ekf"], without), stretched(without, STEP_M), *moves]


def _ablation(rows: pd.DataFrame, trace: pd.DataFrame) -> Claim:
    fell = rows.drop(completed(rows).index)
    different = fell[["survived_s", "distance_m", "com_error_max_mm"]].round({"distance_m": 3, "com_error_max_mm": 1})
    count = len(different.drop_duplicates())
    same = (
        "" if count == len(fell) else "A robot that never stands on the step falls in the same way wherever it begins."
    )
    how = "" if stays_low(trace) else f"With the edge at {EDGE_M:g} m, {SWINGS_UP}"
    return Claim(
        "falls without the limb limits, ekf",
        "fails",
        f"falls at {len(fell)} of {len(rows)} places, {count} different falls",
        verdict(holds=len(fell) == len(rows), partly=len(fell) > 0),
        " ".join(filter(None, (same, how))),
    )
