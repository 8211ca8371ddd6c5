"""A motion plan alone: from above (Winkler 2017, Fig. 5) and over time (Fig. 2)."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.planners.plan import MotionPlan
from quadlab.plotting.axes.contact_bands import draw_contact_bands, planned_bands
from quadlab.plotting.axes.plan_view import (
    draw_by_phase,
    draw_placed_plan,
    extent_of,
    frame_points,
    plan_points,
    plan_view_legend,
)
from quadlab.plotting.axes.time_rows import BANDS_HEIGHT, share_time
from quadlab.plotting.placed_plan import PlacedPlan, in_plan_frame, stance_spans
from quadlab.plotting.style import COP, LEG_COLOURS, TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEG_COUNT

_ROW_HEIGHT = 1.2  # [in]
_LARGEST_HEIGHT = 3.2  # [in] of the view from above
_FRAME_HEIGHT, _FRAME_WIDTH = 1.0, 0.6  # [in] labels and legend


@paper_style()
def plan_figure(plan: MotionPlan) -> Figure:
    """Return the plan from above, x and y of CoM, CoP and standing feet over time, and the contact schedule."""
    placed = in_plan_frame(plan)
    length, width = extent_of(plan_points(placed))
    top_down = min(_LARGEST_HEIGHT, (TEXT_WIDTH - _FRAME_WIDTH) * float(width / length))
    heights = [top_down, _ROW_HEIGHT, _ROW_HEIGHT, BANDS_HEIGHT]
    figure = Figure((TEXT_WIDTH, sum(heights) + _FRAME_HEIGHT), layout="constrained")
    above, *rows, bands = figure.subplots(len(heights), height_ratios=heights)
    draw_placed_plan(above, placed)
    frame_points(above, plan_points(placed))
    for axis, axes in enumerate(rows):
        draw_over_time(axes, plan, placed, axis)
    draw_contact_bands(bands, planned_bands(plan.schedule))
    share_time(rows, bands, plan.duration_s)
    figure.legend(handles=plan_view_legend(actual=False), loc="outside upper center", ncols=2 * LEG_COUNT)
    figure.align_ylabels()
    return figure


def draw_over_time(axes: Axes, plan: MotionPlan, placed: PlacedPlan, axis: int) -> None:
    """Draw x (``axis`` 0) or y (1) of CoM and CoP, and of every foothold a bar while its foot stands, in [m].

    Args:
        axes: to draw into.
        plan: the plan.
        placed: the same, in the plan frame.
        axis: number of the coordinate.
    """
    for leg, colour in enumerate(LEG_COLOURS):
        spans = stance_spans(plan, leg, plan.duration_s)
        for position, (begin, end) in zip(placed.footholds[leg][:, axis], spans, strict=True):
            axes.plot([begin, end], [position, position], color=colour, lw=2.0, solid_capstyle="butt")
    axes.plot(placed.times_s, placed.cop[:, axis], ".", ms=1.4, mew=0, color=COP)
    draw_by_phase(axes, np.column_stack([placed.times_s, placed.com[:, axis]]), placed.contacts)
    axes.set_ylabel(f"{'xy'[axis]} [m]")
