"""Computing time of the control tick over the trial, against the control period."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.plotting.axes.time_rows import finish_time_rows, legend_above, time_rows
from quadlab.plotting.style import COLUMN_WIDTH, MEASURED, SERIES, paper_style
from quadlab.plotting.trial_view import TrialView

_PARTS = (("model_us", "model"), ("reference_us", "references"), ("solve_us", "optimisation"))


@paper_style()
def timing_figure(view: TrialView) -> Figure:
    """Return the parts of the tick's computing time on top of each other, and the solver's iterations."""
    figure, rows, bands = time_rows(COLUMN_WIDTH, [1.4, 0.6])
    draw_tick_time(rows[0], view)
    legend_above(rows[0])
    rows[1].plot(view.times_s, view.log.control["solver_iterations"], color=MEASURED, lw=0.6)
    rows[1].set_ylabel("solver\niterations")
    finish_time_rows(view, rows, bands)
    figure.align_ylabels()
    return figure


def draw_tick_time(axes: Axes, view: TrialView) -> None:
    """Draw the parts as stacked areas in [ms]; ticks far beyond the period are cut off and counted."""
    parts = [1e-3 * view.log.timing[column].to_numpy(float) for column, _ in _PARTS]
    axes.stackplot(view.times_s, parts, labels=[label for _, label in _PARTS], colors=SERIES[1:], lw=0)
    period_ms = 1e3 * view.period_s
    axes.axhline(period_ms, color=MEASURED, lw=0.7, ls=(0, (4, 2)), label="period")
    ticks = 1e-3 * view.log.timing["tick_us"].to_numpy(float)
    late = float((ticks > period_ms).mean())
    text = (
        f"median {np.median(ticks):.2f}, p99 {np.percentile(ticks, 99):.2f} ms; {100.0 * late:.1f} % above the period"
    )
    axes.text(0.99, 0.97, text, transform=axes.transAxes, ha="right", va="top", fontsize=6.5)
    axes.set_ylim(0.0, max(1.6 * period_ms, 1.3 * float(np.percentile(ticks, 99))))
    axes.set_ylabel("tick [ms]")
