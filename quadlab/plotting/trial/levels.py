"""How well each priority level of the controller was met, over time."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.geometry.rotations import Array
from quadlab.plotting.axes.time_rows import finish_time_rows, time_rows
from quadlab.plotting.style import COLUMN_WIDTH, NEUTRAL, SERIES, paper_style
from quadlab.plotting.trial_view import TrialView

_MET = 1e-6
"""A level whose residual stays below this is written about, not drawn."""
_MET_HEIGHT, _DRAWN_HEIGHT = 0.3, 0.75  # [in]


@paper_style()
def levels_figure(view: TrialView) -> Figure:
    """Return the residual norm of each level, highest priority on top, in the units of its tasks."""
    levels = {name: column.to_numpy(float) for name, column in view.log.levels.items()}
    figure, rows, bands = time_rows(COLUMN_WIDTH, [_MET_HEIGHT if _met(r) else _DRAWN_HEIGHT for r in levels.values()])
    for number, (axes, (name, residual)) in enumerate(zip(rows, levels.items(), strict=True), 1):
        draw_level(axes, view.times_s, residual)
        axes.set_ylabel(f"{number} {name}", rotation=0, ha="right", va="center")
    finish_time_rows(view, rows, bands)
    figure.align_ylabels()
    return figure


def draw_level(axes: Axes, times_s: Array, residual: Array) -> None:
    """Draw the residual of a level, (n,); of one that was met, the largest residual in words."""
    if _met(residual):
        axes.set_yticks([])
        text = f"met throughout (residual below {max(np.nanmax(residual), 1e-15):.0e})"
        axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=NEUTRAL)
        return
    axes.plot(times_s, residual, color=SERIES[0], lw=0.7)
    axes.set_ylim(bottom=0.0)


def _met(residual: Array) -> bool:
    return bool(np.nanmax(residual, initial=0.0) < _MET)
