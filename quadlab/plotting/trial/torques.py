"""Joint torques over time, with the limits of the actuators."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.analysis.trial_log import vectors
from quadlab.geometry.rotations import Array
from quadlab.plotting.axes.time_rows import finish_time_rows, legend_above, time_rows
from quadlab.plotting.style import LEG_COLOURS, MEASURED, TEXT_WIDTH, paper_style
from quadlab.plotting.trial_view import TrialView
from quadlab.robots.legs import JOINTS_PER_LEG, LEG_JOINTS, LEGS

_ROOM = 1.08  # of the limits


@paper_style()
def torques_figure(view: TrialView) -> Figure:
    """Return the torques as applied, one row a joint of the leg, one line a leg."""
    figure, rows, bands = time_rows(TEXT_WIDTH, [1.15] * JOINTS_PER_LEG)
    for joint, axes in enumerate(rows):
        draw_torques(axes, view, joint)
    legend_above(rows[0])
    finish_time_rows(view, rows, bands)
    figure.align_ylabels()
    return figure


def draw_torques(axes: Axes, view: TrialView, joint: int) -> None:
    """Draw the torques of joint number ``joint`` of all legs in [N m], and its limits."""
    torques = vectors(view.log.state, "joint_torque")[:, joint::JOINTS_PER_LEG]
    for leg, colour in enumerate(LEG_COLOURS):
        axes.plot(view.times_s, torques[:, leg], color=colour, lw=0.7, label=LEGS[leg])
    for number, limit in enumerate(np.unique(view.torque_limits[joint::JOINTS_PER_LEG])):
        for sign in (-1.0, 1.0):
            label = "limit" if number == 0 and sign > 0.0 else None
            axes.axhline(sign * limit, color=MEASURED, lw=0.7, ls=(0, (4, 2)), label=label)
    _set_limits(axes, torques, float(view.torque_limits[joint::JOINTS_PER_LEG].max()))
    axes.set_ylabel(f"{LEG_JOINTS[joint]} [N m]")


def _set_limits(axes: Axes, torques: Array, limit: float) -> None:
    bound = limit if np.isfinite(limit) else float(np.abs(torques).max())
    axes.set_ylim(-_ROOM * bound, _ROOM * bound)
