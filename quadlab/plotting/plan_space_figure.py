"""A motion plan in space (the look of Gehring 2017, Fig. 1): feet, CoM, base and support over the ground."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.axes3d import Axes3D

from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan
from quadlab.planners.sampling import Samples, foot_path
from quadlab.plotting.axes.plan_view import COP_DOT, phase_colour, phase_spans, plan_view_legend
from quadlab.plotting.placed_plan import in_plan_frame
from quadlab.plotting.style import LEG_COLOURS, MEASURED, TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEG_COUNT

_HEIGHT = 4.2  # [in]
_STATIONS = 9  # times at which base and legs are drawn
_APEX = 0.07  # [m] drawn height of a swing unless it is given; a plan has footholds only
_HUB: dict[str, Any] = {"ls": "", "marker": "s", "ms": 3.0, "color": MEASURED}
_MARGIN = 0.05  # [m] round what is drawn


@paper_style()
def plan_space_figure(plan: MotionPlan, apex_m: float = _APEX) -> Figure:
    """Return the plan in space: swings as arcs over the ground, CoM, CoP, support areas, and the base if it is planned.

    Args:
        plan: to be drawn; it has no heights of swings.
        apex_m: height of the arcs in [m].
    """
    placed = in_plan_frame(plan)
    figure = Figure((TEXT_WIDTH, _HEIGHT))
    axes: Axes3D = figure.add_axes((0.0, 0.0, 1.0, 0.94), projection="3d")
    for support in placed.supports:
        corners = np.concatenate([support.corners, support.corners[:1]])
        axes.plot(*corners.T, 0.0, color=phase_colour(support.contacts), lw=0.5, alpha=0.4)
    for leg, colour in enumerate(LEG_COLOURS):
        for arc in swing_arcs(plan, leg, apex_m):
            axes.plot(*arc.T, color=colour, lw=1.0)
        for marker, points in (("s", plan.footholds[leg][:1]), ("o", plan.footholds[leg][1:])):
            axes.plot(*points.T, ls="", marker=marker, mfc="w", ms=3.5, mew=0.8, color=colour)
    com = np.array([plan.com(time) for time in placed.times_s])
    for begin, end in phase_spans(placed.contacts):
        axes.plot(*com[begin : end + 1].T, color=phase_colour(placed.contacts[begin]), lw=1.8)
    axes.plot(*placed.cop.T, 0.0, **COP_DOT)
    _draw_legs(axes, plan)
    _frame(axes, np.concatenate([com, *plan.footholds]))
    handles = [*plan_view_legend(actual=False), *([Line2D([], [], **_HUB, label="base")] if plan.base else [])]
    figure.legend(handles=handles, loc="upper center", ncols=2 * LEG_COUNT + 1)
    return figure


def swing_arcs(plan: MotionPlan, leg: int, apex_m: float = _APEX) -> list[Array]:
    """Return each swing of ``leg`` as points in space, (n, 3) in [m], from foothold to foothold, ``apex_m`` high."""
    arcs = []
    swings = plan.schedule.swings[leg]
    for number, swing in enumerate(swings):
        fractions = np.linspace(0.0, 1.0, 25)
        times = swing.start_s + fractions * swing.duration_s
        middle = np.full(len(times), 0.5 * (swing.start_s + swing.end_s))
        ground = foot_path(plan.footholds[leg], swings, Samples(times, middle))
        start, end = plan.footholds[leg][number : number + 2, 2]
        height = start + fractions * (end - start) + 16.0 * apex_m * (fractions * (1.0 - fractions)) ** 2
        arcs.append(np.column_stack([ground, height]))
    return arcs


def _draw_legs(axes: Axes3D, plan: MotionPlan) -> None:
    """Draw at a few times the lines from the CoM, or the planned base, to the standing feet."""
    for time in np.linspace(0.0, plan.duration_s, _STATIONS):
        hub = plan.com(time)
        if plan.base is not None:
            hub = np.array([np.interp(time, plan.base.times_s, values) for values in plan.base.positions.T])
        axes.plot(*hub[:, None], **_HUB)
        for leg in np.flatnonzero(plan.schedule.contacts_at(time)):
            foot = plan.foothold_at(int(leg), float(time))
            axes.plot(*np.stack([hub, foot]).T, color=LEG_COLOURS[leg], lw=0.5, alpha=0.5)


def _frame(axes: Axes3D, points: Array) -> None:
    low, high = points.min(axis=0) - _MARGIN, points.max(axis=0) + _MARGIN
    low[2] = min(0.0, low[2] + _MARGIN)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_zlim(low[2], high[2])
    axes.set_box_aspect(high - low, zoom=1.25)
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.set_zlabel("z [m]")
    axes.locator_params(axis="y", nbins=3)
    axes.locator_params(axis="z", nbins=4)
    axes.view_init(elev=22.0, azim=-60.0)
    for artist in axes.get_children():
        artist.set_clip_on(False)  # the axes' rectangle is smaller than their box
