"""Normal forces under the feet over time: measured and desired."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.plotting.axes.time_rows import finish_time_rows, legend_above, time_rows
from quadlab.plotting.style import LEG_COLOURS, MEASURED, TEXT_WIDTH, paper_style
from quadlab.plotting.trial_view import TrialView
from quadlab.robots.legs import LEG_COUNT, LEGS


@paper_style()
def forces_figure(view: TrialView) -> Figure:
    """Return the normal force of every leg; all rows have the same scale."""
    figure, rows, bands = time_rows(TEXT_WIDTH, [0.75] * LEG_COUNT)
    for leg, axes in enumerate(rows):
        draw_normal_force(axes, view, leg)
    limit = max(axes.get_ylim()[1] for axes in rows)
    for axes in rows:
        axes.set_ylim(0.0, limit)
    legend_above(rows[0])
    finish_time_rows(view, rows, bands)
    figure.align_ylabels()
    return figure


def draw_normal_force(axes: Axes, view: TrialView, leg: int) -> None:
    """Draw the vertical force of the ground on a foot: measured as an area, desired as a line, in [N]."""
    measured = view.log.state[f"foot_force_{LEGS[leg]}_z"].to_numpy(float)
    desired = view.log.control[f"contact_force_desired_{LEGS[leg]}_z"].to_numpy(float)
    colour = LEG_COLOURS[leg]
    axes.fill_between(view.times_s, measured, color=colour, alpha=0.45, lw=0, label="measured")
    axes.plot(view.times_s, measured, color=colour, lw=0.6)
    axes.plot(view.times_s, desired, color=MEASURED, lw=0.6, label="desired")
    axes.set_ylabel(f"{LEGS[leg]} $F_z$ [N]")
