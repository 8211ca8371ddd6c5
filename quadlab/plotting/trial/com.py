"""Centre of mass over time: position with its reference, and the error."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.plotting.axes.time_rows import draw_tracking, finish_time_rows, keep_range, legend_above, time_rows
from quadlab.plotting.style import COLUMN_WIDTH, SERIES, paper_style
from quadlab.plotting.trial_view import TrialView

_LEAST_RANGE_MM = 4.0
_LEAST_RANGE_M = 0.02


@paper_style()
def com_figure(view: TrialView) -> Figure:
    """Return x, y, z and the errors of the centre of mass."""
    figure, rows, bands = time_rows(COLUMN_WIDTH, [0.75, 0.75, 0.75, 0.85])
    for axes, axis in zip(rows, "xyz", strict=False):
        table = view.log.control
        draw_tracking(axes, view.times_s, table[f"com_reference_{axis}"].to_numpy(), table[f"com_{axis}"].to_numpy())
        axes.set_ylabel(f"CoM {axis} [m]")
        keep_range(axes, _LEAST_RANGE_M)
    legend_above(rows[0])
    draw_com_error(rows[3], view)
    finish_time_rows(view, rows, bands)
    figure.align_ylabels()
    return figure


def draw_com_error(axes: Axes, view: TrialView) -> None:
    """Draw measured minus reference in [mm], one line an axis of the world."""
    for axis, colour in zip("xyz", SERIES[1:], strict=True):
        axes.plot(view.times_s, 1e3 * view.log.control[f"com_error_{axis}"], color=colour, label=axis)
    axes.set_ylabel("CoM error\n[mm]")
    keep_range(axes, _LEAST_RANGE_MM)
    legend_above(axes)
