"""Gehring 2017, Fig. 5: a lateral walk that is pushed sideways, from above and over time."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper_figures.known_limits import known_limits
from paper_figures.push_limits import ANYMAL_KG, PUSH_S, limit_claims, speeds_mps
from paper_figures.trial_claims import PAPER_STACK, PAPER_STACK_WHY, VARIANTS, completed, survival
from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan
from quadlab.plotting.intervals import intervals_where
from quadlab.plotting.style import LEG_COLOURS, MEASURED, NEUTRAL, PUSH, REFERENCE, TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEGS

STUDY, LIMITS = "gehring2017_walk_push", "gehring2017_walk_pushes"
CAPTION = (
    "Walk, 5 s and 0.2 m a stride, pushed to the right with 160 N for 0.15 s (J/m = 0.79 m/s) while the left fore "
    "leg swings; our priorities, estimator ekf, seed 1, perturbed start. (a) Mean places of the feet in their "
    "stances. (a, b) Wide blue: desired CoM, dashed: measured CoM. (b) Dotted: CoM of the plan as it was made; "
    "band: push."
)
ARTEFACT = Artefact("G-F5", "Gehring 2017, Fig. 5", "Lateral walk pushed sideways", (STUDY, LIMITS), CAPTION)
NEEDED_MPS = (0.6, 1.0)
"""Smallest and median change of velocity that counts as good."""
RIGHT_DEG, START = 270, "scenario.pushes.0.start_s"
UNLOADED_N, LIFTED_M = 5.0, 0.005
"""Less force than that is next to none; from that height on a foot has left the ground."""


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return (a) footprints and CoM from above and (b) y of the CoM with its reference and the plan over time."""
    trace = results.trace(STUDY, "push")
    figure = Figure(figsize=(TEXT_WIDTH, 2.8), layout="constrained")
    above, over_time = figure.subplots(1, 2)
    _draw_from_above(above, trace)
    over_time.plot(
        trace.index, planned_y(results.plan(STUDY, "push"), trace), ":", color=NEUTRAL, label="CoM as planned"
    )
    over_time.plot(trace.index, trace["control.com_reference_y"], color=REFERENCE, linewidth=2.0, label="desired CoM")
    over_time.plot(trace.index, trace["control.com_y"], "--", color=MEASURED, label="measured CoM")
    pushed = (trace["state.push_force_y"] != 0.0).to_numpy()
    for span in intervals_where(trace.index.to_numpy(), pushed, float(trace.index[-1])):
        over_time.axvspan(span.start_s, span.end_s, color=PUSH, alpha=0.5, lw=0, label="push")
    over_time.set(xlabel="time [s]", ylabel="CoM y [m]")
    over_time.set_title("(b) the reference adapts to the push", loc="left")
    handles = [*above.get_legend_handles_labels()[0], *over_time.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles))
    return figure


def _draw_from_above(axes: Axes, trace: pd.DataFrame) -> None:
    axes.plot(trace["control.com_reference_x"], trace["control.com_reference_y"], color=REFERENCE, linewidth=2.0)
    axes.plot(trace["control.com_x"], trace["control.com_y"], "--", color=MEASURED)
    for leg, colour in zip(LEGS, LEG_COLOURS, strict=True):
        prints = footprints(trace, leg)
        axes.plot(prints["x_m"], prints["y_m"], "o", color=colour, markersize=4.0, alpha=0.7, label=leg)
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axes.set_title("(a) footprints and CoM from above", loc="left")


def footprints(trace: pd.DataFrame, leg: str) -> pd.DataFrame:
    """Return the mean position of the foot in each of its stances, by time."""
    stands = trace[f"control.leg_mode_{leg}"] == 0
    stance = (stands & ~stands.shift(1, fill_value=False)).cumsum()[stands]
    feet = trace.loc[stands, [f"control.foot_position_{leg}_x", f"control.foot_position_{leg}_y"]]
    means = feet.groupby(stance).mean()
    return pd.DataFrame({"x_m": means.iloc[:, 0].to_numpy(), "y_m": means.iloc[:, 1].to_numpy()})


def planned_y(plan: MotionPlan, trace: pd.DataFrame) -> Array:
    """Return y of the CoM in the plan as it was made, in [m], at the times of ``trace``.

    The clock of a plan waits for feet that land late, which is not counted here: compare before and long after a push.
    """
    return np.array([plan.com(float(time_s))[1] for time_s in trace.index])


def unloading(trace: pd.DataFrame, push_s: float) -> tuple[float, float]:
    """Return how long the left hind foot bears next to nothing in a planned stance, in [s], and how it lifts, in [m].

    Args:
        trace: of the pushed trial.
        push_s: when the push begins in [s]; the second after it counts.
    """
    second = trace.loc[push_s : push_s + 1.0]
    idle = (second["state.foot_force_LH_z"] < UNLOADED_N) & (second["control.planned_contact_LH"] > 0.0)
    heights = second["control.foot_position_LH_z"]
    lifted = (heights[idle] - heights.iloc[0]).max() if idle.any() else 0.0
    return float(idle.sum() * np.median(np.diff(second.index))), float(lifted)


def at_push(limits: pd.DataFrame, push_s: float) -> "pd.Series[float]":
    """Return the largest push to the right survived at ``push_s`` in [s], J / m in [m/s], by variant."""
    rows = limits[(limits["direction"] == RIGHT_DEG) & np.isclose(limits[START], push_s)]
    return pd.Series(speeds_mps(rows).to_numpy(), index=rows["variant"])


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return the CoM, its reference and the push over time."""
    trace = results.trace(STUDY, "push")
    columns = ["control.com_x", "control.com_y", "control.com_reference_x", "control.com_reference_y"]
    return trace[[*columns, "state.push_force_x", "state.push_force_y"]].reset_index()


def claims(results: StudyResults) -> list[Claim]:
    """Return that it recovers, that a foot loses contact, how the reference adapts, and the largest pushes."""
    table, trace = results.table(STUDY), results.trace(STUDY, "push")
    pushed = trace.index[(trace["state.push_force_y"] != 0.0).to_numpy()]
    off_mm = 1e3 * (trace["control.com_reference_y"] - planned_y(results.plan(STUDY, "push"), trace))
    moved_mm = float(off_mm.iloc[-1] - off_mm.loc[: pushed[0]].iloc[-1])
    push_mps = float(trace["state.push_force_y"].abs().max()) * PUSH_S / ANYMAL_KG
    right = at_push(known_limits(results, LIMITS), float(pushed[0]))
    name = f"after a push to the right of {push_mps:.2g} m/s"
    return [
        *(
            survival(f"stays up {name} with our priorities, {estimator}", rows, "recovers", why=_failures(rows))
            for estimator, rows in table.groupby("estimator")
        ),
        _paper_stack(right[PAPER_STACK], push_mps, name),
        _without_alignment(right["alignment none"], right["reference"], push_mps, name),
        _contact_lost(*unloading(trace, pushed[0])),
        Claim(
            "the reference in y adapts: moved off the plan as it was made",
            "adapts",
            f"by {abs(moved_mm):.0f} mm to the {'left' if moved_mm > 0.0 else 'right'}",
            verdict(holds=abs(moved_mm) > 10.0),
        ),
        *limit_claims(known_limits(results, LIMITS), results.table(LIMITS), NEEDED_MPS, f"walk, {PUSH_S} s, ekf"),
    ]


def _failures(rows: pd.DataFrame) -> str:
    """Return how trials failed, as a sentence."""
    failed = rows.drop(completed(rows).index)
    refused = int((failed["status"] == "planning_failed").sum())
    return f"{refused} plans from perturbed starts refused by the checker, {len(failed) - refused} other failures."


def _paper_stack(largest_mps: float, push_mps: float, name: str) -> Claim:
    holds = largest_mps >= push_mps
    ours = f"largest push survived there {largest_mps:.2f} m/s"
    text = f"stays up {name} {VARIANTS[PAPER_STACK]}, ekf"
    return Claim(text, "recovers; size not printed", ours, verdict(holds=holds), "" if holds else PAPER_STACK_WHY)


def _without_alignment(largest_mps: float, aligned_mps: float, push_mps: float, name: str) -> Claim:
    """Return the claim that the alignment is what keeps the robot up."""
    falls = largest_mps < push_mps
    ours = f"largest push survived there {largest_mps:.2f} m/s, {aligned_mps:.2f} m/s with alignment"
    why = f"Alignment is worth {aligned_mps - largest_mps:.2f} m/s to this walk; the push of the paper is not printed."
    text = f"falls {name} without alignment of the plan, ekf"
    return Claim(text, "did not fall due to the alignment", ours, verdict(holds=falls), "" if falls else why)


def _contact_lost(unloaded_s: float, lifted_m: float) -> Claim:
    ours = (
        f"below {UNLOADED_N:g} N for {1e3 * unloaded_s:.0f} ms of the second after the push begins, where it stands by "
        f"plan; it lifts {1e3 * lifted_m:.1f} mm"
    )
    holds = unloaded_s > 0.0 and lifted_m >= LIFTED_M
    why = "" if holds else "It is unloaded but stays on the ground." if unloaded_s > 0.0 else "It stays loaded."
    text = "the left hind foot loses contact"
    return Claim(text, "yes", ours, verdict(holds=holds, partly=unloaded_s > 0.0), why)
