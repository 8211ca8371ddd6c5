"""Winkler 2017, Fig. 5: plans of walk, trot, pace and bound from above."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.planners.plan import MotionPlan
from quadlab.plotting.placed_plan import in_plan_frame
from quadlab.plotting.style import COP, GROUND, LEG_COLOURS, MEASURED, TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEGS

STUDY = "winkler2017_table1"
ARTEFACT = Artefact("W-F5", "Winkler 2017, Fig. 5", "Walk, trot, pace and bound from above", (STUDY,))
GAITS = ("walk", "trot", "pace", "bound")
INSIDE_MM = 0.1


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return one panel a gait: support areas, footholds, CoM and CoP."""
    figure = Figure(figsize=(TEXT_WIDTH, 3.5), layout="constrained")
    for axes, gait in zip(figure.subplots(2, 2, sharex=True, sharey=True).flat, GAITS, strict=True):
        draw_from_above(axes, results.plan(STUDY, gait))
        axes.set_title(gait, loc="left")
    for place in (2, 3):
        figure.axes[place].set_xlabel("x [m]")
    for place in (0, 2):
        figure.axes[place].set_ylabel("y [m]")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=6)
    return figure


def draw_from_above(axes: Axes, plan: MotionPlan) -> None:
    """Draw the hull of the standing feet of every phase, the footholds by leg, CoM and CoP."""
    placed = in_plan_frame(plan)
    for support in placed.supports:
        outline = Polygon(support.corners, closed=len(support.corners) > 2, facecolor=GROUND, edgecolor=GROUND)
        outline.set_alpha(0.25)
        axes.add_patch(outline)
    for leg, colour, places in zip(LEGS, LEG_COLOURS, placed.footholds, strict=False):
        axes.plot(*places.T, "o", color=colour, markersize=3.0, label=leg)
    axes.plot(*placed.com.T, color=MEASURED, label="CoM")
    axes.plot(*placed.cop.T, ".", color=COP, markersize=1.5, label="CoP")
    axes.set_aspect("equal")


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
