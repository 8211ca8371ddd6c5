"""Winkler 2017, V: HyQ walks and trots with schedules and distances of Table I, by projected inverse dynamics."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper_figures.trial_claims import completed, survival
from quadlab.analysis.artefact import Artefact, Claim, Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.axes.plan_view import COP_DOT
from quadlab.plotting.style import MEASURED, NEUTRAL, REFERENCE, SERIES, TEXT_WIDTH, paper_style

STUDY = "winkler2017_tracking"
CAPTION = (
    "HyQ with projected inverse dynamics at 250 Hz, 16 steps over 1 m with the schedules of Table I. The plans have "
    "0.8 s (walk) or 0.6 s (trot) of standing before and after and the default costs of the fast planner, which the "
    "plans of Table I have not. Above, y enlarged: perturbed start, seed 0, estimator ekf; wide blue: desired CoM; "
    "dashed: true CoM; red: desired CoP. Below: error of the true CoM in x-y, in this trial, in the same one planned "
    "anew every 0.3 s from the estimated state, and in one without anything random, estimator truth and nominal start."
)
ARTEFACT = Artefact(
    "W-X1", "Winkler 2017, V", "HyQ walks and trots as long and as far as in Table I", (STUDY,), CAPTION
)
GAITS = ("walk", "trot")
TRACES = {
    "": ("ekf, perturbed start", MEASURED),
    "_replanned": ("the same, replanned", SERIES[1]),
    "_nominal": ("truth, nominal start", NEUTRAL),
}
"""How the names of traces end, what they show and its colour."""
SHOWN = next(iter(TRACES.values()))[0]
PRINTED_HZ = 250
STARTS = {
    "nominal": "the nominal start",
    "perturbed": "perturbed starts",
    "replanned": "perturbed starts, replanned every 0.3 s",
}


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return, a column a gait, the CoM from above and the norm of its error over time."""
    table = numbers(results)
    figure = Figure(figsize=(TEXT_WIDTH, 3.4), layout="constrained")
    for column, gait in zip(figure.subplots(2, len(GAITS), sharey="row").T, GAITS, strict=True):
        rows = table[table["gait"] == gait]
        _draw_from_above(column[0], rows[rows["trial"] == SHOWN])
        column[0].set_title(f"{gait}, {PRINTED_HZ} Hz, {SHOWN}", loc="left")
        for name, colour in TRACES.values():
            trial = rows[rows["trial"] == name]
            column[1].plot(trial["time_s"], trial["error_mm"], color=colour, label=name)
        column[1].set(xlabel="time [s]", ylim=(0.0, None))
    for axes, label in zip(figure.axes[:: len(GAITS)], ("y [m]", "CoM error [mm]"), strict=True):
        axes.set_ylabel(label)
    figure.axes[-1].legend(loc="upper right")
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


def _draw_from_above(axes: Axes, rows: pd.DataFrame) -> None:
    axes.plot(rows["cop_x_m"], rows["cop_y_m"], **COP_DOT, label="desired CoP")
    axes.plot(rows["reference_x_m"], rows["reference_y_m"], color=REFERENCE, linewidth=2.0, label="desired CoM")
    axes.plot(rows["com_x_m"], rows["com_y_m"], "--", color=MEASURED, label="true CoM")
    axes.set_xlabel("x [m]")


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return CoM, reference, desired CoP and error over time, one block a gait and trial."""
    return pd.concat([_curves(results, gait, end) for gait in GAITS for end in TRACES], ignore_index=True)


def _curves(results: StudyResults, gait: str, end: str) -> pd.DataFrame:
    trace = results.trace(STUDY, f"{gait}{end}")
    sources = {"reference": "com_reference", "com": "com", "cop": "cop_reference"}
    places = {
        f"{name}_{axis}_m": np.asarray(trace[f"control.{column}_{axis}"])
        for name, column in sources.items()
        for axis in "xy"
    }
    error = 1e3 * np.linalg.norm(trace[["control.com_error_x", "control.com_error_y"]], axis=1)
    names = {"gait": gait, "trial": TRACES[end][0]}
    return pd.DataFrame({**names, "time_s": trace.index.to_numpy(), **places, "error_mm": error})


def claims(results: StudyResults) -> list[Claim]:
    """Return that both gaits stay up and how closely they follow, by rate and estimator."""
    table = results.table(STUDY)
    found = []
    for (gait, rate, estimator), rows in table.groupby(["gait", "rate_hz", "estimator"], sort=False):
        name = f"{gait}, {rate} Hz, {estimator}"
        found.append(survival(f"stays up: {name}", rows, "the real robot did" if rate == PRINTED_HZ else "-"))
        for start, group in completed(rows).groupby("start", sort=False):
            found.append(_com_error(f"CoM error from {STARTS[str(start)]}: {name}", group["com_error_max_mm"]))
    return found


def _com_error(text: str, largest_mm: "pd.Series[float]") -> Claim:
    ours = f"{largest_mm.median():.3g} mm median, {largest_mm.max():.3g} mm worst of {len(largest_mm)}"
    return Claim(text, "not printed", ours, Verdict.NEW)
