"""Winkler 2017, Fig. 5: plans of walk, trot, pace and bound from above."""

import pandas as pd
from matplotlib.figure import Figure

from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.axes.plan_view import draw_placed_plan, plan_view_legend
from quadlab.plotting.placed_plan import in_plan_frame
from quadlab.plotting.style import TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEG_COUNT

STUDY = "winkler2017_table1"
CAPTION = (
    "Plans of Table I, 16 steps over 1 m, from above: (a) walk, (b) trot, (c) pace, (d) bound. Squares: initial "
    "stance; circles: footholds; lines: CoM in the colour of the leg that swings, grey where all stand; red: CoP; "
    "areas: support. The cost of the walk, even loads, leaves the footholds free, and the other gaits have no cost: "
    "a plan may first go backwards. Nothing is simulated."
)
ARTEFACT = Artefact("W-F5", "Winkler 2017, Fig. 5", "Walk, trot, pace and bound from above", (STUDY,), CAPTION)
GAITS = ("walk", "trot", "pace", "bound")
INSIDE_MM = 0.1


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
    """Return how far the CoP leaves the support areas, as the independent checker finds on its dense grid."""
    verdicts = [results.plan(STUDY, gait).verdict for gait in GAITS]
    worst = max(found.values["cop_outside_mm"] for found in verdicts)  # noqa: PD011 - no table
    text = "CoP inside every support area: farthest outside [mm]"
    return [Claim(text, "inside", f"{worst:.1g}, four gaits", verdict(holds=worst < INSIDE_MM))]
