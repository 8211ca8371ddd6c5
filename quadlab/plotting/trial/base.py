"""Height and orientation of the base over time, with their references."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.geometry.rotations import Array
from quadlab.plotting.axes.time_rows import draw_tracking, finish_time_rows, keep_range, legend_above, time_rows
from quadlab.plotting.style import COLUMN_WIDTH, paper_style
from quadlab.plotting.trial_view import TrialView

_LEAST_RANGE_DEG = 2.0
_LEAST_RANGE_M = 0.02


@paper_style()
def base_figure(view: TrialView) -> Figure:
    """Return height, roll, pitch and yaw of the base."""
    figure, rows, bands = time_rows(COLUMN_WIDTH, [0.75] * 4)
    draw_base_height(rows[0], view)
    legend_above(rows[0])
    for axes, angle in zip(rows[1:], ("roll", "pitch", "yaw"), strict=True):
        draw_base_angle(axes, view, angle)
    finish_time_rows(view, rows, bands)
    figure.align_ylabels()
    return figure


def draw_base_height(axes: Axes, view: TrialView) -> None:
    """Draw the height of the base's origin in the world in [m]."""
    reference = view.log.control["base_height_reference"].to_numpy(float)
    draw_tracking(axes, view.times_s, reference, view.log.state["base_position_z"].to_numpy(float))
    axes.set_ylabel("height [m]")
    keep_range(axes, _LEAST_RANGE_M)


def draw_base_angle(axes: Axes, view: TrialView, angle: str) -> None:
    """Draw roll, pitch or yaw in [deg]."""
    draw_tracking(axes, view.times_s, _degrees(view, f"base_reference_{angle}"), _degrees(view, f"base_{angle}"))
    axes.set_ylabel(f"{angle} [deg]")
    keep_range(axes, _LEAST_RANGE_DEG)


def _degrees(view: TrialView, column: str) -> Array:
    return np.degrees(np.unwrap(view.log.control[column].to_numpy(float)))
