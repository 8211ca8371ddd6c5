"""Gehring 2017, Fig. 7: a trot that turns 20 deg a stride is pushed twice."""

from typing import TypeAlias

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper_figures.known_limits import known_limits
from paper_figures.push_limits import PUSH_S, limit_claims
from paper_figures.trial_claims import paper_stack, survival, variant_claims
from quadlab.analysis.artefact import Artefact, Claim, Verdict, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.plotting.intervals import Interval
from quadlab.plotting.style import COLUMN_WIDTH, MEASURED, NEUTRAL, PUSH, REFERENCE, paper_style

STUDY, LIMITS = "gehring2017_turning_trot", "gehring2017_trot_pushes"
CAPTION = (
    "Trot that turns 20 deg a stride, pushed with 140 N for 0.15 s (J/m = 0.69 m/s) along y at 2.4 s and against "
    "x at 4.8 s of the world (bands); our priorities, estimator ekf, seed 0, perturbed start. Wide blue: desired "
    "yaw; dashed: measured; grey: the same trial without pushes."
)
ARTEFACT = Artefact("G-F7", "Gehring 2017, Fig. 7", "Turning trot that is pushed", (STUDY, LIMITS), CAPTION)
PAIRS = {"pushed": "not_pushed", "pushed_1": "not_pushed_1", "pushed_2": "not_pushed_2"}
"""Trials with the same seed, with and without pushes."""
PUSHED = (*PAIRS, "pushed_truth")
TRACES = (*PUSHED, *PAIRS.values())
STAYS_UP = "stays up; push not printed"
DEVIATES_MM = 50.0
"""Farther off than that, a push shows in the path."""
SETTLED = 0.1
"""A deviation that changes by less than this share of it within a stride has settled."""
YAW_BOUND_DEG = 2.5
TURN_OFF = 0.05
"""Share by which the angle turned may be off."""
NEEDED_MPS = (0.6, 1.2)
"""Smallest and median change of velocity that counts as good for a trot straight on."""
DEGREES_A_STRIDE = 20.0
Trials: TypeAlias = dict[str, pd.DataFrame]
"""What ``numbers`` returns of each trial, by time."""


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
    schedule = results.plan(STUDY, "not_pushed").schedule
    trials = {str(name): rows.set_index("time_s") for name, rows in curves.groupby("trial")}
    return [
        *(
            survival(f"stays up under two pushes of 0.7 m/s with our priorities, {name}", rows, STAYS_UP)
            for name, rows in reference.groupby("estimator")
        ),
        paper_stack(table, STAYS_UP, "stays up under two pushes of 0.7 m/s"),
        turned(trials, len(schedule.swings[0])),
        yaw_change(trials),
        _tracking(trials),
        deviation(trials),
        settling(trials, last_stride(schedule)),
        *variant_claims(table),
        *limit_claims(
            known_limits(results, LIMITS), results.table(LIMITS), NEEDED_MPS, f"trot straight on, {PUSH_S} s, ekf"
        ),
    ]


def last_stride(schedule: ContactSchedule) -> Interval:
    """Return the stride that ends when the last leg lands for good."""
    last = max((legs[-2:] for legs in schedule.swings), key=lambda swings: swings[-1].end_s)
    return Interval(last[0].end_s, last[1].end_s)


def turned(trials: Trials, strides: int) -> Claim:
    """Return by how much the yaw of the pushed robots grows, beside ``strides`` times the angle of a stride."""
    wanted = DEGREES_A_STRIDE * strides
    angles = [_turned_deg(trials[name]) for name in PUSHED]
    holds = all(abs(angle / wanted - 1.0) <= TURN_OFF for angle in angles)
    free = _turned_deg(trials["not_pushed"])
    ours = f"{min(angles):.1f} to {max(angles):.1f} in {len(angles)} kept trials, {free:.1f} without pushes"
    text = f"yaw goes on: turned in {strides} strides [deg]"
    return Claim(text, f"{wanted:g}, {DEGREES_A_STRIDE:g} a stride", ours, verdict(holds=holds))


def _turned_deg(trial: pd.DataFrame) -> float:
    return float(trial["yaw_deg"].iloc[-1] - trial["yaw_deg"].iloc[0])


def yaw_change(trials: Trials) -> Claim:
    """Return by how much pushes change the yaw."""
    changes = [float((trials[name]["yaw_deg"] - trials[free]["yaw_deg"]).abs().max()) for name, free in PAIRS.items()]
    ours = f"{max(changes):.1f}, largest of {len(changes)} pairs of trials"
    text = "yaw goes on: largest difference from the same trial without pushes [deg]"
    return Claim(text, "yaw continues", ours, verdict(holds=max(changes) <= YAW_BOUND_DEG))


def _tracking(trials: Trials) -> Claim:
    """Return how closely the yaw follows its reference, which turns with the robot."""
    errors = {
        name: float(np.sqrt(np.mean((rows["yaw_deg"] - rows["reference_deg"]) ** 2))) for name, rows in trials.items()
    }
    worst = max(errors[name] for name in PUSHED)
    ours = f"{worst:.2f} worst of {len(PUSHED)} kept trials, {errors['not_pushed']:.2f} without pushes"
    text = "yaw against its reference, which is aligned with the robot: rms error [deg]"
    return Claim(text, "not printed", ours, Verdict.NEW)


def apart_mm(trials: Trials) -> list["pd.Series[float]"]:
    """Return how far the pushed robots are from those that are not pushed, in [mm] over time."""
    place = ["base_x_m", "base_y_m"]
    return [
        1e3 * (trials[name][place] - trials[free][place]).dropna().pow(2).sum(axis=1).pow(0.5)
        for name, free in PAIRS.items()
    ]


def deviation(trials: Trials) -> Claim:
    """Return how far the pushed robots get off the path of those that are not pushed."""
    apart = apart_mm(trials)
    ends = [float(values.iloc[-1]) for values in apart]
    return Claim(
        "horizontal position deviates",
        "x-y deviates",
        f"up to {max(values.max() for values in apart):.0f} mm off the path without pushes, {min(ends):.0f} to "
        f"{max(ends):.0f} mm at the end of {len(apart)} pairs of trials",
        verdict(holds=min(values.max() for values in apart) >= DEVIATES_MM),
        "The plan is aligned with the robot: its circle goes on where the pushes left the robot.",
    )


def settling(trials: Trials, stride: Interval) -> Claim:
    """Return by how much that distance still changes within ``stride``."""
    last = [values.loc[stride.start_s : stride.end_s] for values in apart_mm(trials)]
    changes = [float(np.ptp(values)) for values in last]
    shares = [change / float(values.mean()) for change, values in zip(changes, last, strict=True)]
    ours = f"{max(changes):.0f} mm, {100 * max(shares):.0f} % of it, largest of {len(last)} pairs of trials"
    text = "the deviation settles: its change within the last stride"
    return Claim(text, "settles", ours, verdict(holds=max(shares) <= SETTLED))
