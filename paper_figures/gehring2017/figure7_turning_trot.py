"""Gehring 2017, Fig. 7: a trot that turns 20 deg a stride is pushed twice."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper_figures.push_limits import PUSH_S, limit_claims
from paper_figures.trial_claims import VARIANTS, survival, variant_claims
from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.geometry.rotations import Array
from quadlab.plotting.style import COLUMN_WIDTH, MEASURED, PUSH, REFERENCE, paper_style

STUDY, LIMITS = "gehring2017_turning_trot", "gehring2017_trot_pushes"
ARTEFACT = Artefact("G-F7", "Gehring 2017, Fig. 7", "Turning trot that is pushed", (STUDY, LIMITS))
TRACES = ("pushed", "pushed_1", "pushed_2", "pushed_truth", "not_pushed")
YAW_BOUND_DEG = 2.5
NEEDED_MPS = (0.6, 1.2)
"""Smallest and median change of velocity that counts as good for a trot straight on."""
DEGREES_A_STRIDE = 20.0


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return yaw and horizontal position of the base over time, with the pushes."""
    trace = results.trace(STUDY, "pushed")
    figure = Figure(figsize=(COLUMN_WIDTH, 3.4), layout="constrained")
    for_yaw, for_x, for_y = figure.subplots(3, 1, sharex=True)
    times = trace.index.to_numpy()
    yaw, reference = _angles_deg(trace)
    for_yaw.plot(times, reference, color=REFERENCE, linewidth=2.0, label="desired")
    for_yaw.plot(times, yaw, "--", color=MEASURED, label="measured")
    for_yaw.set_ylabel("yaw [deg]")
    for axes, axis in ((for_x, "x"), (for_y, "y")):
        axes.plot(times, trace[f"state.base_position_{axis}"], color=MEASURED)
        axes.set_ylabel(f"base {axis} [m]")
    for axes in (for_yaw, for_x, for_y):
        _mark_pushes(axes, trace)
    for_yaw.legend(loc="upper left", ncols=3)
    for_y.set_xlabel("time [s]")
    return figure


def _mark_pushes(axes: Axes, trace: pd.DataFrame) -> None:
    pushed = np.linalg.norm(trace[["state.push_force_x", "state.push_force_y"]], axis=1) > 0.0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], pushed, [False]]).astype(int)))
    times = trace.index.to_numpy()
    for number, (start, end) in enumerate(edges.reshape(-1, 2)):
        axes.axvspan(times[start], times[end - 1], color=PUSH, alpha=0.5, label="" if number else "push")


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return yaw, its reference and the position of the base over time, one block a trial."""
    return pd.concat([_curves(results, name) for name in TRACES], ignore_index=True)


def _curves(results: StudyResults, name: str) -> pd.DataFrame:
    trace = results.trace(STUDY, name)
    yaw, reference = _angles_deg(trace)
    curves = {"time_s": trace.index.to_numpy(), "yaw_deg": yaw, "reference_deg": reference}
    position = {f"base_{axis}_m": np.asarray(trace[f"state.base_position_{axis}"]) for axis in "xy"}
    return pd.DataFrame({"trial": name, **curves, **position})


def _angles_deg(trace: pd.DataFrame) -> tuple[Array, Array]:
    yaw, reference = (np.degrees(np.unwrap(trace[f"control.base_{key}"])) for key in ("yaw", "reference_yaw"))
    return yaw, reference


def claims(results: StudyResults) -> list[Claim]:
    """Return that it stays up, keeps turning, what holds it up, and the largest pushes of a trot."""
    table, curves = results.table(STUDY), numbers(results)
    reference = table[table["variant"] == "reference"]
    errors = {
        name: float(np.sqrt(np.mean((rows["yaw_deg"] - rows["reference_deg"]) ** 2)))
        for name, rows in curves.groupby("trial")
    }
    worst = max(errors[name] for name in TRACES if name.startswith("pushed"))
    settled = _settled_mm(results.trace(STUDY, "pushed"))
    return [
        *(
            survival(f"stays up under two pushes of 0.7 m/s, {name}", rows, "stays up; push not printed")
            for name, rows in reference.groupby("estimator")
        ),
        Claim(
            f"yaw goes on at {DEGREES_A_STRIDE:g} deg a stride: rms error [deg]",
            "yaw follows",
            f"{worst:.2f} worst of four kept trials, {errors['not_pushed']:.2f} without pushes",
            verdict(holds=worst <= YAW_BOUND_DEG),
        ),
        Claim(
            "horizontal position deviates, then settles",
            "deviates and settles",
            f"up to {reference['com_error_max_mm'].median():.0f} mm off the plan, {settled:.0f} mm at the end",
            verdict(holds=settled < 20.0),
            "Off the plan as it is aligned; off the place that was planned before the pushes, the robot stays.",
        ),
        *variant_claims(table, "variant", VARIANTS),
        *limit_claims(results.limits(LIMITS), results.table(LIMITS), NEEDED_MPS, f"trot straight on, {PUSH_S} s, ekf"),
    ]


def _settled_mm(trace: pd.DataFrame) -> float:
    last = trace.iloc[-1]
    offset = [last[f"control.com_{axis}"] - last[f"control.com_reference_{axis}"] for axis in "xy"]
    return 1e3 * float(np.hypot(*offset))
