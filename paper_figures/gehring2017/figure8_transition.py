"""Gehring 2017, Fig. 8: pictures of a walk that becomes a trot, at swing apexes and touch-downs."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.image import imread

from paper_figures.trial_claims import STACKS, at_most, survival
from quadlab.analysis.artefact import Artefact, Claim
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEGS
from quadlab.studies.config import load_study

STUDY = "gehring2017_transition"
CAPTION = (
    "From a walk of 4 s to two strides of a trot of 0.8 s; our priorities, estimator ekf, seed 0, nominal start. "
    "Seen from the right and somewhat from ahead. Above each picture its time and which legs are at the apex of "
    "their swing or touch down, by plan."
)
ARTEFACT = Artefact("G-F8", "Gehring 2017, Fig. 8", "Transition from walk to trot", (STUDY,), CAPTION)
COLUMNS = 4
AROUND_S = 0.04
"""A foot that lands by plan within that time of a picture touches down in it."""
COM_BOUND_MM = 12.0


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return the pictures in the order of time."""
    pictures = results.snapshots(STUDY, "transition")
    times, trace = snapshot_times(), results.trace(STUDY, "transition")
    rows = -(-len(pictures) // COLUMNS)
    figure = Figure(figsize=(TEXT_WIDTH, 1.35 * rows), layout="constrained")
    panels = figure.subplots(rows, COLUMNS, squeeze=False).flatten()
    for axes in panels:
        axes.set_axis_off()
    for number, (path, time_s) in enumerate(zip(pictures, times, strict=True), 1):
        axes, picture = panels[number - 1], imread(path)
        height, width = picture.shape[:2]
        axes.imshow(picture[int(0.15 * height) : int(0.8 * height), int(0.2 * width) : int(0.9 * width)])
        axes.set_title(f"{number}: {time_s:.6g} s, {moment(trace, time_s)}", fontsize=6.5)
    return figure


def moment(trace: pd.DataFrame, time_s: float) -> str:
    """Return which legs touch down at ``time_s`` in [s] by plan, or else which are in the air, e.g. "apex LF"."""
    columns = [f"control.planned_contact_{leg}" for leg in LEGS]
    places = [int(np.argmin(np.abs(trace.index - time))) for time in (time_s - AROUND_S, time_s + AROUND_S)]
    before, after = trace[columns].to_numpy()[places] > 0.0
    landed, swinging = (" ".join(np.array(LEGS)[flags]) for flags in (after & ~before, ~after))
    return f"touch-down {landed}" if landed else f"apex {swinging}"


def snapshot_times() -> tuple[float, ...]:
    """Return when the pictures were taken, in [s], as the study says."""
    return tuple(next(trace.snapshots_s for trace in load_study(STUDY).traces if trace.name == "transition"))


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return which legs stand and how far the CoM is off, at each picture."""
    trace = results.trace(STUDY, "transition")
    places = [int(np.argmin(np.abs(trace.index - time_s))) for time_s in snapshot_times()]
    rows = trace.iloc[places]
    legs = {f"stands_{leg}": np.asarray(rows[f"control.planned_contact_{leg}"], dtype=int) for leg in LEGS}
    error = np.hypot(np.asarray(rows["control.com_error_x"]), np.asarray(rows["control.com_error_y"]))
    return pd.DataFrame({"time_s": rows.index.to_numpy(), **legs, "com_error_mm": 1e3 * error})


def claims(results: StudyResults) -> list[Claim]:
    """Return that it stays up and how closely it follows, with our priorities and with those of the paper.

    With the true state nothing is random: that trial stands beside those with the noise of sensors.
    """
    table = results.table(STUDY)
    column, above = "com_error_max_mm", f"More than the {COM_BOUND_MM:g} mm aimed at here."
    return [
        *(
            survival(f"stays up with {text}, ekf and truth", table[table["controller"] == stack], "stays up")
            for stack, text in STACKS.items()
        ),
        *(
            at_most(
                f"CoM error with {STACKS[str(stack)]}, {estimator}",
                rows,
                column,
                COM_BOUND_MM,
                "mm",
                paper="not printed",
                why=above,
            )
            for (stack, estimator), rows in table.groupby(["controller", "estimator"], sort=False)
        ),
    ]
