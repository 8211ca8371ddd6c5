"""Bellicoso 2016, Fig. 5 and 6: a walk down a 14 cm step that nobody announced, with and without limb limits."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import imread

from paper_figures.trial_claims import completed, survival
from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import LEG_COLOURS, MEASURED, REFERENCE, SERIES, TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEGS

STUDY = "bellicoso2016_step_down"
ARTEFACT = Artefact("B-F56", "Bellicoso 2016, Fig. 5 and 6", "An unperceived step down of 14 cm", (STUDY,))
TRACES = {"with limb limits": "with_limits", "without": "without_limits"}
PICTURES = 6
NEEDED = 8
"""How many of ten places count as good."""
STEP_M, LEG_LENGTH_M = 0.14, 0.564


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return pictures of the descent above base height, pitch, roll and foot heights over time."""
    figure = Figure(figsize=(TEXT_WIDTH, 5.6), layout="constrained")
    pictures, curves = np.asarray(figure.subfigures(2, 1, height_ratios=(1.0, 3.4))).tolist()
    _draw_pictures(pictures.subplots(1, PICTURES), results)
    panels = curves.subplots(3, 2, sharex="col", sharey="row")
    for column, (name, trace) in zip(panels.T, TRACES.items(), strict=True):
        _draw_trial(column, results.trace(STUDY, trace))
        column[0].set_title(name, loc="left")
    panels[0, 0].legend(loc="lower left", ncols=2)
    panels[1, 0].legend(loc="lower left", ncols=2)
    panels[2, 0].legend(loc="lower left", ncols=4)
    return figure


def _draw_pictures(panels: "np.ndarray[tuple[int], np.dtype[np.object_]]", results: StudyResults) -> None:
    found = results.snapshots(STUDY, "with_limits")
    chosen = [found[place] for place in np.linspace(0, len(found) - 1, PICTURES).round().astype(int)]
    for axes, path in zip(panels, chosen, strict=True):
        picture = imread(path)
        width = picture.shape[1]
        axes.imshow(picture[:, int(0.1 * width) : int(0.9 * width)])
        axes.set_axis_off()


def _draw_trial(panels: "np.ndarray[tuple[int], np.dtype[np.object_]]", trace: pd.DataFrame) -> None:
    for_height, for_angles, for_feet = panels
    times = trace.index.to_numpy()
    for_height.plot(times, trace["state.base_position_z"], color=MEASURED, label="measured")
    for_height.plot(times, trace["control.base_height_reference"], color=REFERENCE, linestyle="--", label="desired")
    for name, colour in (("pitch", SERIES[1]), ("roll", SERIES[2])):
        for_angles.plot(times, np.degrees(trace[f"control.base_{name}"]), color=colour, label=name)
        for_angles.plot(times, np.degrees(trace[f"control.base_reference_{name}"]), ":", color=colour)
    for leg, colour in zip(LEGS, LEG_COLOURS, strict=True):
        for_feet.plot(times, trace[f"control.foot_position_{leg}_z"], color=colour, label=leg)
    _label(for_height, "base height [m]", (0.2, 0.56))
    _label(for_angles, "angle [deg]", (-16.0, 16.0))
    _label(for_feet, "foot height [m]", (-0.25, 0.15))
    for_feet.set_xlabel("time [s]")


def _label(axes: Axes, text: str, limits: tuple[float, float]) -> None:
    axes.set_ylim(*limits)
    if axes.get_subplotspec().is_first_col():  # type: ignore[union-attr]
        axes.set_ylabel(text)


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return height, angles and foot heights over time, one block a trial."""
    return pd.concat([_curves(results, name) for name in (*TRACES.values(), "with_limits_truth")], ignore_index=True)


def _curves(results: StudyResults, name: str) -> pd.DataFrame:
    trace = results.trace(STUDY, name)
    angles = {f"{key}_deg": np.degrees(np.asarray(trace[f"control.base_{key}"])) for key in ("pitch", "roll")}
    feet = {f"{leg}_z_m": np.asarray(trace[f"control.foot_position_{leg}_z"]) for leg in LEGS}
    height = {"base_z_m": np.asarray(trace["state.base_position_z"])}
    return pd.DataFrame({"trial": name, "time_s": trace.index.to_numpy(), **height, **angles, **feet})


def claims(results: StudyResults) -> list[Claim]:
    """Return at how many places the step is passed, with and without limb limits, and how the torso adapts."""
    table = results.table(STUDY)
    groups = dict(list(table.groupby(["limits", "estimator"])))
    step = f"{100 * STEP_M:.0f} cm ({100 * STEP_M / LEG_LENGTH_M:.0f} % of thigh and shank)"
    slips = "Where it falls, a foot has touched the edge itself, slips off it and is searched for too late."
    good = [
        survival(f"walks down {step} with limb limits, {name}", groups["with", name], "succeeds", NEEDED, slips)
        for name in ("ekf", "truth")
    ]
    without = groups["without", "ekf"]
    fell = len(without) - len(completed(without))
    return [*good, _ablation(fell, len(without)), _adaptation(numbers(results))]


def _ablation(fell: int, count: int) -> Claim:
    return Claim(
        "falls without the limb limits, ekf",
        "fails",
        f"falls at {fell} of {count} places",
        verdict(holds=fell == count, partly=fell > 0),
        "Counted as falls only; whether they fall for the reason that the paper gives was not diagnosed.",
    )


def _adaptation(curves: pd.DataFrame) -> Claim:
    rows = curves[curves["trial"] == "with_limits"]
    drop_mm = 1e3 * (rows["base_z_m"].iloc[0] - rows["base_z_m"].iloc[-1])
    pitch, roll = (rows[f"{key}_deg"].abs().max() for key in ("pitch", "roll"))
    ours = f"height -{drop_mm:.0f} mm at the end, pitch up to {pitch:.1f} deg, roll up to {roll:.1f} deg"
    moves = drop_mm > 500.0 * STEP_M and min(pitch, roll) > 1.0
    return Claim("height, pitch and roll adapt", "adapt", ours, verdict(holds=bool(moves)))
