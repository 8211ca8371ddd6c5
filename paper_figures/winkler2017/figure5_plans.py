"""Winkler 2017, Fig. 5: plans of walk, trot, pace and bound from above."""

from collections.abc import Iterable

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from paper_figures.winkler2017.figure2_trot_overview import ENFORCED
from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan
from quadlab.plotting.axes.plan_view import draw_placed_plan, plan_view_legend
from quadlab.plotting.placed_plan import PlacedPlan, in_plan_frame
from quadlab.plotting.style import TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEG_COUNT, LEGS

STUDY = "winkler2017_table1"
CAPTION = (
    "Plans of Table I, 16 steps over 1 m, from above: (a) walk, (b) trot, (c) pace, (d) bound. Squares: initial "
    "stance; circles: footholds; lines: CoM in the colour of the leg that swings, grey where all stand; red: CoP "
    "every 10 ms; areas: support. The walk, whose only cost is even loads, first goes backwards in a loop, and LH "
    "first steps back; the other gaits have no cost. Nothing is simulated."
)
ARTEFACT = Artefact("W-F5", "Winkler 2017, Fig. 5", "Walk, trot, pace and bound from above", (STUDY,), CAPTION)
GAITS = ("walk", "trot", "pace", "bound")
STRIDES = 4
INSIDE_MM = 0.1
BACK_MM = 1.0
"""A CoM that goes back by less goes from left to right."""
SWAY_MM = 10.0
"""A CoM that turns round by less does not sway."""
NEAR = 1.5
"""By that factor the CoP of the trot is nearer to the CoM in the middle, at least."""


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return one panel a gait: support areas, initial stance, footholds, CoM in the colour of the swing, and CoP."""
    figure = Figure(figsize=(TEXT_WIDTH, 3.5), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True, sharey=True).flat
    for axes, letter, gait in zip(panels, "abcd", GAITS, strict=True):
        draw_placed_plan(axes, in_plan_frame(results.plan(STUDY, gait)))
        axes.set_aspect("equal")
        axes.set_title(f"({letter}) {gait}", loc="left")
    for place in (2, 3):
        figure.axes[place].set_xlabel("x [m]")
    for place in (0, 2):
        figure.axes[place].set_ylabel("y [m]")
    figure.legend(handles=plan_view_legend(actual=False), loc="outside upper center", ncols=2 * LEG_COUNT)
    return figure


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return CoM and CoP over time, one block a gait."""
    blocks = []
    for gait in GAITS:
        placed = in_plan_frame(results.plan(STUDY, gait))
        curves = dict(zip(("com_x_m", "com_y_m", "cop_x_m", "cop_y_m"), [*placed.com.T, *placed.cop.T], strict=True))
        blocks.append(pd.DataFrame({"gait": gait, "time_s": placed.times_s, **curves}))
    return pd.concat(blocks, ignore_index=True)


def claims(results: StudyResults) -> list[Claim]:
    """Return where the CoM goes, how it sways, where the CoP of the trot is, and that the CoP is in the supports."""
    plans = {gait: results.plan(STUDY, gait) for gait in GAITS}
    placed = {gait: in_plan_frame(plan) for gait, plan in plans.items()}
    return [
        forward_claim("walk", placed["walk"], _ahead(plans["walk"], placed["walk"])),
        *(forward_claim(gait, placed[gait]) for gait in ("trot", "pace")),
        sway_claim("walk: left-right swaying of the body", placed["walk"].com[:, 1]),
        near_claim(placed["trot"]),
        sway_claim("pace: sideways swaying motion of the CoM", placed["pace"].com[:, 1]),
        sway_claim("bound: forward backward motion of the CoM", placed["bound"].com[:, 0]),
        _inside(plans.values()),
    ]


def forward_claim(gait: str, plan: PlacedPlan, why: str = "") -> Claim:
    """Return how far the CoM ever goes back from where it was."""
    x_mm = 1e3 * plan.com[:, 0]
    back_mm = float((np.maximum.accumulate(x_mm) - x_mm).max())
    holds = back_mm <= BACK_MM
    text = f"{gait}: the robot moves from left to right: farthest way back of the CoM [mm]"
    return Claim(text, "from left to right", f"{back_mm:.0f}", verdict(holds=holds), "" if holds else why)


def _ahead(plan: MotionPlan, placed: PlacedPlan) -> str:
    """Return why a walk goes backwards whose CoP is ahead of the CoM in its first phase."""
    first = placed.times_s < plan.schedule.switch_times_s[1]
    ahead_mm = 1e3 * float(np.mean((placed.cop - placed.com)[first, 0]))
    leg = LEGS[int(np.flatnonzero(~plan.schedule.contacts[0])[0])]
    return (
        f"Even loads are the only cost: while {leg} swings, first in the order in which the caption of the paper lists "
        f"the legs, they put the CoP {ahead_mm:.0f} mm ahead of the CoM on average, which thus falls backwards. Begun "
        "with a fore leg, the same walk does not go back; how the walk of the paper begins is not printed."
    )


def sway_claim(text: str, values_m: Array) -> Claim:
    """Return how often a coordinate of the CoM, (n,) in [m], turns round; once a stride is swaying."""
    values_mm = 1e3 * values_m
    turns = turning_points(values_mm, SWAY_MM)
    ours = f"{values_mm.min():.0f} to {values_mm.max():.0f} mm, turns round {turns} times in {STRIDES} strides"
    return Claim(text, "sways", ours, verdict(holds=turns >= STRIDES, partly=turns > 0))


def turning_points(values: Array, least: float) -> int:
    """Return how often ``values``, (n,), turn round to go back by ``least`` or more."""
    turns, direction, extreme = 0, 0.0, values[0]
    for value in values:
        if direction == 0.0:
            direction = float(np.sign(value - values[0])) if abs(value - values[0]) >= least else 0.0
            extreme = value
        elif direction * (value - extreme) >= 0.0:
            extreme = value
        elif abs(value - extreme) >= least:
            turns, direction, extreme = turns + 1, -direction, value
    return turns


def near_claim(plan: PlacedPlan) -> Claim:
    """Return how far the CoP is from the CoM in the first and last quarter of a plan, and in the middle."""
    distance_mm = 1e3 * np.linalg.norm(plan.cop - plan.com, axis=1)
    start, *middle, end = np.array_split(distance_mm, 4)
    means = [float(part.mean()) for part in (start, np.concatenate(middle), end)]
    ours = "{:.0f} in the first quarter, {:.0f} in the middle, {:.0f} in the last quarter".format(*means)
    far = [means[place] >= NEAR * means[1] for place in (0, 2)]
    text = "trot: CoP close to the CoM in the middle, far at start and end: mean distance [mm]"
    return Claim(text, "close, far at both ends", ours, verdict(holds=all(far), partly=any(far)))


def _inside(plans: Iterable[MotionPlan]) -> Claim:
    """Return how far the CoP leaves the support areas, as the independent checker finds on its dense grid."""
    worst = max(plan.verdict.values["cop_outside_mm"] for plan in plans)  # noqa: PD011 - no table
    text = "CoP inside every support area: farthest outside [mm]"
    return Claim(text, "inside", f"{worst:.1g}, four gaits", verdict(holds=worst < INSIDE_MM), ENFORCED)
