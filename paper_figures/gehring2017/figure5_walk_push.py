"""Gehring 2017, Fig. 5: a lateral walk that is pushed sideways, from above and over time."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper_figures.known_limits import known_limits
from paper_figures.push_limits import ANYMAL_KG, PUSH_S, limit_claims, speeds_mps
from paper_figures.trial_claims import PAPER_STACK, VARIANTS, completed, survival
from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.controllers.telemetry import LegMode
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan
from quadlab.plotting.intervals import intervals_where
from quadlab.plotting.style import LEG_COLOURS, MEASURED, NEUTRAL, PUSH, REFERENCE, TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEGS

STUDY, LIMITS = "gehring2017_walk_push", "gehring2017_walk_pushes"
CAPTION = (
    "Walk, 5 s and 0.2 m a stride, pushed to the right with 160 N for 0.15 s (J/m = 0.79 m/s) while the left fore "
    "leg swings; our priorities, estimator ekf, seed 1, perturbed start. (a) Dots: places of the feet while they "
    "stand, 100 a second; black crosses: of the left hind foot where it stands by plan and bears less than 5 N in the "
    "second after the push begins, also enlarged; rings: their means, one a stance. (a, b) Wide blue: desired CoM, "
    "dashed: measured CoM. (b) Dotted: CoM of the plan as it was made; band: push."
)
ARTEFACT = Artefact("G-F5", "Gehring 2017, Fig. 5", "Lateral walk pushed sideways", (STUDY, LIMITS), CAPTION)
NEEDED_MPS = (0.6, 1.0)
"""Smallest and median change of velocity that counts as good."""
RIGHT_DEG, START = 270, "scenario.pushes.0.start_s"
UNLOADED_N, LIFTED_M = 5.0, 0.005
"""Less force than that is next to none; from that height on a foot has left the ground."""
GAP_S = 0.05
"""A contact that is lost for less time goes on."""
ADAPTS_M = 0.01
"""By so much a reference has to move with the push."""
PAPER_STACK_FALLS = (
    "Neither the size of the push nor the gains of the drives are printed. That the base stands above the legs in the "
    "air matters less on three feet than on two, see a row below. Why it falls before our priorities is not isolated."
)
PIECE, NEAR_M = (0.26, 0.62, 0.3, 0.3), np.array([-0.015, 0.015])
"""Where the enlarged piece is drawn, in shares of the axes, and what it shows round the left hind foot."""


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
        axes.plot(*_places(trace[stands(trace, leg)], leg).T, "o", color=colour, ms=1.5, mew=0.0)
        prints = footprints(trace, leg)
        axes.plot(prints["x_m"], prints["y_m"], "o", color=colour, ms=7.0, mfc="none", mew=0.8, label=leg)
    _draw_left_hind(axes, trace)
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axes.set_title("(a) footprints and CoM from above", loc="left")


def _draw_left_hind(axes: Axes, trace: pd.DataFrame) -> None:
    """Mark where the left hind foot bears next to nothing, in ``axes`` and in an enlarged piece of it."""
    idle = _places(trace[unloaded(trace, push_start_s(trace))], "LH")
    middle = idle.mean(axis=0)
    near = axes.inset_axes(
        PIECE, xlim=middle[0] + NEAR_M, ylim=middle[1] + NEAR_M, xticks=[], yticks=[], aspect="equal"
    )
    near.plot(*_places(trace[stands(trace, "LH")], "LH").T, "o", color=LEG_COLOURS[LEGS.index("LH")], ms=2.5, mew=0.0)
    for piece in (axes, near):
        piece.plot(*idle.T, "x", color=MEASURED, ms=3.0, mew=0.6, label="LH unloaded")
    near.set_title(f"{1e3 * np.ptp(NEAR_M):.0f} mm wide", fontsize="small", pad=2.0)
    near.spines[["top", "right"]].set_visible(True)
    axes.indicate_inset_zoom(near)


def _places(trace: pd.DataFrame, leg: str) -> Array:
    """Return x and y of the foot, (n, 2) in [m]."""
    return trace[[f"control.foot_position_{leg}_x", f"control.foot_position_{leg}_y"]].to_numpy()


def stands(trace: pd.DataFrame, leg: str) -> BoolArray:
    """Return whether the foot stands, (n,); contacts that are lost for less than ``GAP_S`` go on."""
    times, flags = trace.index.to_numpy(), (trace[f"control.leg_mode_{leg}"] == LegMode.STANCE).to_numpy()
    for gap in intervals_where(times, ~flags, float(times[-1])):
        flags = flags | ((gap.duration_s < GAP_S) & (times >= gap.start_s) & (times < gap.end_s))
    return flags


def footprints(trace: pd.DataFrame, leg: str) -> pd.DataFrame:
    """Return the mean position of the foot in each of its stances, by time."""
    times = trace.index.to_numpy()
    spans = intervals_where(times, stands(trace, leg), float(times[-1]))
    means = [_places(trace[(times >= span.start_s) & (times < span.end_s)], leg).mean(axis=0) for span in spans]
    return pd.DataFrame(means, columns=["x_m", "y_m"])


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
    idle = unloaded(trace, push_s)
    heights = trace["control.foot_position_LH_z"]
    lifted = (heights[idle] - heights.loc[push_s:].iloc[0]).max() if idle.any() else 0.0
    return float(idle.sum() * np.median(np.diff(trace.index))), float(lifted)


def unloaded(trace: pd.DataFrame, push_s: float) -> BoolArray:
    """Return where the left hind foot bears next to nothing though it stands by plan, within a second of ``push_s``."""
    soon = (trace.index >= push_s) & (trace.index <= push_s + 1.0)
    idle = (trace["state.foot_force_LH_z"] < UNLOADED_N) & (trace["control.planned_contact_LH"] > 0.0)
    return soon & idle.to_numpy()


def push_start_s(trace: pd.DataFrame) -> float:
    """Return when the push begins in [s]."""
    return float(trace.index[(trace["state.push_force_y"] != 0.0).to_numpy()][0])


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
    push_s = push_start_s(trace)
    push_mps = float(trace["state.push_force_y"].abs().max()) * PUSH_S / ANYMAL_KG
    right = at_push(known_limits(results, LIMITS), push_s)
    name = f"after a push to the right of {push_mps:.2g} m/s"
    times = " or ".join(f"{time_s:g}" for time_s in sorted(table[START].unique()))
    return [
        *(
            survival(
                f"stays up {name} at {times} s with our priorities, {estimator}", rows, "recovers", why=_failures(rows)
            )
            for estimator, rows in table.groupby("estimator")
        ),
        _paper_stack(right[PAPER_STACK], push_mps, f"{name} at {push_s:g} s"),
        _without_alignment(right["alignment none"], right["reference"], push_mps, f"{name} at {push_s:g} s"),
        _contact_lost(*unloading(trace, push_s)),
        reference_adapts(trace, planned_y(results.plan(STUDY, "push"), trace)),
        *limit_claims(known_limits(results, LIMITS), results.table(LIMITS), NEEDED_MPS, f"walk, {PUSH_S} s, ekf"),
    ]


def reference_adapts(trace: pd.DataFrame, planned_m: Array) -> Claim:
    """Return whether the reference of the CoM, which was ``planned_m``, (n,) in [m], moves to where the push goes."""
    off = trace["control.com_reference_y"] - planned_m
    push = trace["state.push_force_y"]
    moved = float(off.iloc[-1] - off.loc[: push_start_s(trace)].iloc[-1])
    text = "the reference in y adapts: moved off the plan as it was made, with the push"
    ours = f"by {1e3 * abs(moved):.0f} mm to the {'left' if moved > 0.0 else 'right'}"
    return Claim(text, "adapts", ours, verdict(holds=moved * np.sign(push.iloc[int(push.abs().argmax())]) >= ADAPTS_M))


def _failures(rows: pd.DataFrame) -> str:
    """Return how trials failed, as a sentence."""
    failed = rows.drop(completed(rows).index)
    refused = int((failed["status"] == "planning_failed").sum())
    return f"{refused} plans from perturbed starts refused by the checker, {len(failed) - refused} other failures."


def _paper_stack(largest_mps: float, push_mps: float, name: str) -> Claim:
    holds = largest_mps >= push_mps
    ours = f"largest push survived there {largest_mps:.2f} m/s, one search"
    text = f"stays up {name} {VARIANTS[PAPER_STACK]}, ekf"
    return Claim(text, "recovers; size not printed", ours, verdict(holds=holds), "" if holds else PAPER_STACK_FALLS)


def _without_alignment(largest_mps: float, aligned_mps: float, push_mps: float, name: str) -> Claim:
    """Return the claim that the alignment is what keeps the robot up."""
    falls = largest_mps < push_mps
    ours = f"largest push survived there {largest_mps:.2f} m/s, {aligned_mps:.2f} m/s with alignment, one search each"
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
