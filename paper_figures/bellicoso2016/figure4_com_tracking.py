"""Bellicoso 2016, Fig. 4: how closely the centre of mass follows a ZMP walk."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from paper_figures.trial_claims import at_most, survival
from quadlab.analysis.artefact import Artefact, Claim
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import COLUMN_WIDTH, MEASURED, REFERENCE, SERIES, paper_style

STUDY = "bellicoso2016_com_tracking"
CAPTION = (
    "ZMP walk on level ground with the priorities of the paper, start at rest. Above: CoM as the controller "
    "believes it, estimator ekf, seed 0. Wide blue: desired, dashed: measured. Below: error in x-y as the "
    "controller believes it, with both estimators; dotted: bound of the paper."
)
ARTEFACT = Artefact(
    "B-F4", "Bellicoso 2016, Fig. 4", "Tracking of the centre of mass over a ZMP walk", (STUDY,), CAPTION
)
BOUND_MM = 3.4
"""Upper bound of the position error in the paper."""
PAPER = "3.4 mm, axes not printed"
TRACES = {"ekf": "paper_ekf", "truth": "paper_truth"}


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return x and y of the CoM and its reference, and the norm of the error, over time."""
    table = numbers(results)
    figure = Figure(figsize=(COLUMN_WIDTH, 3.4), layout="constrained")
    for_x, for_y, for_error = figure.subplots(3, 1, sharex=True)
    rows = table[table["estimator"] == "ekf"]
    for axes, axis in ((for_x, "x"), (for_y, "y")):
        axes.plot(rows["time_s"], rows[f"reference_{axis}_m"], color=REFERENCE, linewidth=2.0, label="desired")
        axes.plot(rows["time_s"], rows[f"com_{axis}_m"], "--", color=MEASURED, label="measured")
        axes.set_ylabel(f"CoM {axis} [m]")
    for_x.legend(loc="upper left", ncols=2)
    for estimator, colour in zip(TRACES, SERIES, strict=False):
        rows = table[table["estimator"] == estimator]
        for_error.plot(rows["time_s"], rows["error_mm"], color=colour, label=estimator)
    for_error.axhline(BOUND_MM, color=SERIES[2], linestyle=":", label=f"paper's bound, {BOUND_MM} mm")
    for_error.set(xlabel="time [s]", ylabel="error x-y [mm]", ylim=(0.0, 1.6 * BOUND_MM))
    for_error.legend(loc="upper center", ncols=3)
    return figure


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return reference, CoM as the controller believed it, and the error's norm, over time, one block an estimator."""
    return pd.concat([_curves(results, estimator, name) for estimator, name in TRACES.items()], ignore_index=True)


def _curves(results: StudyResults, estimator: str, name: str) -> pd.DataFrame:
    trace = results.trace(STUDY, name)
    return pd.DataFrame(
        {
            "estimator": estimator,
            "time_s": trace.index,
            "reference_x_m": trace["control.com_reference_x"].to_numpy(),
            "reference_y_m": trace["control.com_reference_y"].to_numpy(),
            "com_x_m": trace["control.com_x"].to_numpy(),
            "com_y_m": trace["control.com_y"].to_numpy(),
            "error_mm": 1e3 * np.linalg.norm(trace[["control.com_error_x", "control.com_error_y"]], axis=1),
        }
    )


def claims(results: StudyResults) -> list[Claim]:
    """Return the bound of the paper beside what the controller believed and what was true."""
    table = results.table(STUDY)
    stack = table[table["controller"] == "bellicoso2016"]
    rest, perturbed = (stack[stack["start"] == start] for start in ("at rest", "perturbed"))
    with_ekf, with_truth = (rest[rest["estimator"] == estimator] for estimator in ("ekf", "truth"))
    drift = "The true error holds what drifts in the estimate of the position, which nothing on the robot measures."
    believed, true, unit = "com_error_believed_max_mm", "com_error_max_mm", "mm"
    name = "CoM error in x-y"
    return [
        at_most(f"{name} by the robot's own estimate, ekf", with_ekf, believed, BOUND_MM, unit, paper=PAPER),
        at_most(f"true {name}, ekf", with_ekf, true, BOUND_MM, unit, paper="not measured", why=drift),
        at_most(f"{name}, estimator truth", with_truth, true, BOUND_MM, unit, paper=PAPER),
        *(
            at_most(f"true {name} from perturbed starts, {estimator}", rows, true, BOUND_MM, unit, paper="not printed")
            for estimator, rows in perturbed.groupby("estimator")
        ),
        survival("walks from perturbed starts, ekf and truth", perturbed, "-"),
    ]
