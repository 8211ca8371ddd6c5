"""Gehring 2017, Fig. 7: a trot that turns 20 deg a stride is pushed twice."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper_figures.known_limits import known_limits
from paper_figures.push_limits import PUSH_S, limit_claims
from paper_figures.trial_claims import paper_stack, survival, variant_claims
from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.geometry.rotations import Array
from quadlab.plotting.style import COLUMN_WIDTH, MEASURED, NEUTRAL, PUSH, REFERENCE, paper_style

STUDY, LIMITS = "gehring2017_turning_trot", "gehring2017_trot_pushes"
CAPTION = (
    "Trot that turns 20 deg a stride, pushed with 140 N for 0.15 s (J/m = 0.69 m/s) along y at 2.4 s and against "
    "x at 4.8 s of the world (bands); our priorities, estimator ekf, seed 0, perturbed start. Wide blue: desired "
    "yaw; dashed: measured; grey: the same trial without pushes."
)
ARTEFACT = Artefact("G-F7", "Gehring 2017, Fig. 7", "Turning trot that is pushed", (STUDY, LIMITS), CAPTION)
TRACES = ("pushed", "pushed_1", "pushed_2", "pushed_truth", "not_pushed")
STAYS_UP = "stays up; push not printed"
DEVIATES_MM = 50.0
"""Farther off than that, a push shows in the path."""
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
    free = results.trace(STUDY, "not_pushed")
    for axes, axis in ((for_x, "x"), (for_y, "y")):
        axes.plot(free.index, free[f"state.base_position_{axis}"], color=NEUTRAL, label="without pushes")
        axes.plot(times, trace[f"state.base_position_{axis}"], "--", color=MEASURED)
        axes.set_ylabel(f"base {axis} [m]")
    for axes in (for_yaw, for_x, for_y):
        _mark_pushes(axes, trace)
    handles = {
        label: line for axes in (for_yaw, for_x) for line, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    figure.legend(handles.values(), handles, loc="outside upper center", ncols=len(handles))
    for_y.set_xlabel("time [s]")
    figure.align_ylabels()
    return figure


def _mark_pushes(axes: Axes, trace: pd.DataFrame) -> None:
    pushed = np.linalg.norm(trace[["state.push_force_x", "state.push_force_y"]], axis=1) > 0.0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], pushed, [False]]).astype(int)))
    times = trace.index.to_numpy()
    for number, (start, end) in enumerate(edges.reshape(-1, 2)):
        axes.axvspan(times[start], times[end - 1], color=PUSH, alpha=0.5, lw=0, label="" if number else "push")


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
    return [
        *(
            survival(f"stays up under two pushes of 0.7 m/s with our priorities, {name}", rows, STAYS_UP)
            for name, rows in reference.groupby("estimator")
        ),
        paper_stack(table, STAYS_UP, "stays up under two pushes of 0.7 m/s"),
        Claim(
            f"yaw goes on at {DEGREES_A_STRIDE:g} deg a stride: rms error [deg]",
            "yaw follows",
            f"{worst:.2f} worst of four kept trials, {errors['not_pushed']:.2f} without pushes",
            verdict(holds=worst <= YAW_BOUND_DEG),
        ),
        _deviation(curves),
        *variant_claims(table),
        *limit_claims(
            known_limits(results, LIMITS), results.table(LIMITS), NEEDED_MPS, f"trot straight on, {PUSH_S} s, ekf"
        ),
    ]


def _deviation(curves: pd.DataFrame) -> Claim:
    """Return how far the pushed robot gets off the path of the one that is not pushed."""
    pushed, free = (
        curves.loc[curves["trial"] == name, ["base_x_m", "base_y_m"]].to_numpy() for name in ("pushed", "not_pushed")
    )
    count = min(len(pushed), len(free))
    apart_mm = 1e3 * np.linalg.norm(pushed[:count] - free[:count], axis=1)
    return Claim(
        "horizontal position deviates",
        "x-y deviates",
        f"up to {apart_mm.max():.0f} mm off the path without pushes, {apart_mm[-1]:.0f} mm at the end",
        verdict(holds=bool(apart_mm.max() >= DEVIATES_MM)),
        "The plan is aligned with the robot: its circle goes on where the pushes left the robot.",
    )
