"""The story of a trial on one page."""

import textwrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.analysis.trial_log import vectors
from quadlab.plotting.axes.plan_view import extent_of, plan_view_legend
from quadlab.plotting.axes.time_rows import BANDS_HEIGHT, finish_time_rows, legend_above
from quadlab.plotting.style import LEG_COLOURS, MEASURED, TEXT_WIDTH, paper_style
from quadlab.plotting.trial.base import draw_base_angle, draw_base_height
from quadlab.plotting.trial.com import draw_com_error
from quadlab.plotting.trial.feet import draw_side_view
from quadlab.plotting.trial.top_down import aligned_plan, draw_world_view, world_points
from quadlab.plotting.trial_view import TrialView
from quadlab.robots.legs import JOINTS_PER_LEG, LEGS
from quadlab.trials.report import key_numbers

_SIDE_HEIGHT, _ROW_HEIGHT = 0.7, 0.7  # [in]
_TOP_DOWN_HEIGHTS = (1.2, 2.6)  # [in] least and largest
_FRAME_WIDTH, _FRAME_HEIGHT = 0.6, 2.6  # [in] of labels, legends and title
_LINE_LENGTH = 128  # characters of the title


@paper_style()
def overview_figure(view: TrialView) -> Figure:
    """Return one page: title with key numbers, view from above, feet from the side, tracking, torques, contacts."""
    followed = aligned_plan(view)
    length, width = extent_of(world_points(view, followed))
    top_down = float(np.clip((TEXT_WIDTH - _FRAME_WIDTH) * width / length, *_TOP_DOWN_HEIGHTS))
    heights = [top_down, _SIDE_HEIGHT, *[_ROW_HEIGHT] * 5, BANDS_HEIGHT]
    figure = Figure((TEXT_WIDTH, sum(heights) + _FRAME_HEIGHT), layout="constrained")
    figure.suptitle(title(view), x=0.01, ha="left", fontsize=7.5)
    rows = figure.subplots(len(heights), height_ratios=heights)
    draw_world_view(rows[0], view, followed)
    rows[0].legend(
        handles=plan_view_legend(actual=True), loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=10, fontsize=6.5
    )
    draw_side_view(rows[1], view, LEGS)
    rows[1].set_xlabel("x [m]")
    legend_above(rows[1])
    _draw_time_rows(view, list(rows[2:-1]), rows[-1])
    figure.align_ylabels(rows[1:])
    return figure


def title(view: TrialView) -> str:
    """Return what the trial was and what came of it, in a few lines."""
    words = view.log.metadata
    parts = [view.config[group]["kind"] for group in ("planner", "controller", "estimator")]
    what = [words["robot"], words["gait"], *parts, view.config["scenario"]["name"], f"seed {view.config['seed']}"]
    lines = [" · ".join(what)]
    if view.result is None:
        return "\n".join([*lines, "the trial has left no result"])
    numbers = [f"{label} {value}" for label, value in key_numbers(view.result)]
    lines.append(f"{view.result.status}: {view.result.status_reason}")
    return "\n".join([*lines, *textwrap.wrap(" · ".join(numbers), _LINE_LENGTH)])


def draw_torque_use(axes: Axes, view: TrialView) -> None:
    """Draw the largest torque of each leg relative to its limit in [%]."""
    use = 100.0 * np.abs(vectors(view.log.state, "joint_torque")) / view.torque_limits
    for leg, (name, colour) in enumerate(zip(LEGS, LEG_COLOURS, strict=True)):
        of_leg = use[:, JOINTS_PER_LEG * leg : JOINTS_PER_LEG * (leg + 1)]
        axes.plot(view.times_s, of_leg.max(axis=1), color=colour, lw=0.6, label=name)
    axes.axhline(100.0, color=MEASURED, lw=0.7, ls=(0, (4, 2)))
    axes.set_ylim(0.0, 105.0)
    axes.set_ylabel("torque\n[% of limit]")


def _draw_time_rows(view: TrialView, rows: list[Axes], bands: Axes) -> None:
    draw_com_error(rows[0], view)
    draw_base_height(rows[1], view)
    legend_above(rows[1])
    draw_base_angle(rows[2], view, "pitch")
    draw_base_angle(rows[3], view, "yaw")
    draw_torque_use(rows[4], view)
    finish_time_rows(view, rows, bands)
