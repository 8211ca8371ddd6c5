"""Winkler 2017, V: HyQ walks and trots with schedules and distances of Table I, by projected inverse dynamics."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from paper_figures.trial_claims import at_most, completed, survival
from quadlab.analysis.artefact import Artefact, Claim
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import COP, MEASURED, REFERENCE, TEXT_WIDTH, paper_style

STUDY = "winkler2017_tracking"
CAPTION = (
    "HyQ with projected inverse dynamics at 250 Hz, 16 steps over 1 m with the schedules of Table I; estimator "
    "truth, nominal start, nothing is random. The plans have 0.8 s (walk) or 0.6 s (trot) of standing before and "
    "after and the default costs of the fast planner, which the plans of Table I have not. Wide blue: desired "
    "CoM; dashed: measured CoM; red: desired CoP. Below: error of the CoM in x-y."
)
ARTEFACT = Artefact(
    "W-X1", "Winkler 2017, V", "HyQ walks and trots as long and as far as in Table I", (STUDY,), CAPTION
)
GAITS = ("walk", "trot")
COM_BOUND_MM = 5.0
FALLS = "The falls were not diagnosed."
PRINTED_HZ = 250
STARTS = {"nominal": "the nominal start", "perturbed": "perturbed starts"}


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return, a column a gait, the CoM from above and the norm of its error over time."""
    table = numbers(results)
    figure = Figure(figsize=(TEXT_WIDTH, 3.2), layout="constrained")
    for column, gait in zip(figure.subplots(2, len(GAITS), squeeze=False).T, GAITS, strict=True):
        rows = table[table["gait"] == gait]
        above, over_time = column
        above.plot(rows["cop_x_m"], rows["cop_y_m"], ".", color=COP, markersize=1.5, label="desired CoP")
        above.plot(rows["reference_x_m"], rows["reference_y_m"], color=REFERENCE, linewidth=2.0, label="desired CoM")
        above.plot(rows["com_x_m"], rows["com_y_m"], "--", color=MEASURED, label="measured CoM")
        above.set(xlabel="x [m]", ylabel="y [m]")
        above.set_title(f"{gait}, {PRINTED_HZ} Hz, true state, nominal start", loc="left")
        over_time.plot(rows["time_s"], rows["error_mm"], color=MEASURED)
        over_time.set(xlabel="time [s]", ylabel="CoM error [mm]", ylim=(0.0, None))
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return CoM, reference, desired CoP and error over time, one block a gait."""
    return pd.concat([_curves(results, gait) for gait in GAITS], ignore_index=True)


def _curves(results: StudyResults, gait: str) -> pd.DataFrame:
    trace = results.trace(STUDY, gait)
    sources = {"reference": "com_reference", "com": "com", "cop": "cop_reference"}
    places = {
        f"{name}_{axis}_m": np.asarray(trace[f"control.{column}_{axis}"])
        for name, column in sources.items()
        for axis in "xy"
    }
    error = 1e3 * np.linalg.norm(trace[["control.com_error_x", "control.com_error_y"]], axis=1)
    return pd.DataFrame({"gait": gait, "time_s": trace.index.to_numpy(), **places, "error_mm": error})


def claims(results: StudyResults) -> list[Claim]:
    """Return that both gaits stay up and how closely they follow, by rate and estimator."""
    table = results.table(STUDY)
    found = []
    for (gait, rate, estimator), rows in table.groupby(["gait", "rate_hz", "estimator"], sort=False):
        name = f"{gait}, {rate} Hz, {estimator}"
        found.append(
            survival(f"stays up: {name}", rows, "the real robot did" if rate == PRINTED_HZ else "-", why=FALLS)
        )
        for start, group in rows.groupby("start", sort=False):
            if len(completed(group)):
                text = f"CoM error from {STARTS[str(start)]}: {name}"
                found.append(at_most(text, group, "com_error_max_mm", COM_BOUND_MM, "mm", paper="not printed"))
    return found
