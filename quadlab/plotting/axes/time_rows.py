"""Rows of axes over one time axis, the lowest with the contact bands."""

from collections.abc import Sequence

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.geometry.rotations import Array
from quadlab.plotting.axes.contact_bands import contact_band_legend, draw_contact_bands
from quadlab.plotting.axes.pushes import push_legend, shade_pushes
from quadlab.plotting.style import MEASURED, REFERENCE
from quadlab.plotting.trial_view import TrialView

BANDS_HEIGHT = 0.62  # [in]
_FRAME_HEIGHT = 0.7  # [in] legends and labels above and below the rows
_LEGEND_COLUMN = 0.85  # [in]


def time_rows(width: float, heights: Sequence[float]) -> tuple[Figure, list[Axes], Axes]:
    """Return a figure, its rows, and the axes of the contact bands under them.

    Args:
        width: of the figure in [in].
        heights: of the rows in [in].
    """
    all_heights = [*heights, BANDS_HEIGHT]
    figure = Figure((width, sum(all_heights) + _FRAME_HEIGHT), layout="constrained")
    axes = figure.subplots(len(all_heights), squeeze=False, height_ratios=all_heights)[:, 0]
    return figure, list(axes[:-1]), axes[-1]


def finish_time_rows(view: TrialView, rows: Sequence[Axes], bands: Axes) -> None:
    """Draw contact bands and pushes, with a legend below; give all rows the same time axis, labelled once."""
    draw_contact_bands(bands, view.bands)
    for axes in (*rows, bands):
        shade_pushes(axes, view.pushes)
    share_time(rows, bands, view.end_s)
    _legend_below(bands, [*contact_band_legend(view.bands), *push_legend(view.pushes)])


def share_time(rows: Sequence[Axes], lowest: Axes, end_s: float) -> None:
    """Give ``rows`` and the ``lowest`` axes the same time axis up to ``end_s`` in [s], labelled once."""
    for axes in (*rows, lowest):
        axes.set_xlim(0.0, end_s)
        axes.tick_params(labelbottom=axes is lowest)
    lowest.set_xlabel("time [s]")


def draw_tracking(axes: Axes, times_s: Array, reference: Array, measured: Array) -> None:
    """Draw a reference, wide and pale, and on it what was measured; each (n,), NaN where there is none."""
    axes.plot(times_s, reference, color=REFERENCE, lw=2.2, alpha=0.8, label="reference")
    axes.plot(times_s, measured, color=MEASURED, lw=0.8, label="measured")


def legend_above(axes: Axes) -> None:
    """Put the legend of ``axes`` over its right end, in one line."""
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles, labels, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=len(handles))


def keep_range(axes: Axes, least: float) -> None:
    """Widen the y axis to at least ``least`` about its middle, so that noise is not blown up."""
    low, high = axes.get_ylim()
    if high - low < least:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.5 * least, middle + 0.5 * least)


def _legend_below(axes: Axes, handles: Sequence[Artist]) -> None:
    figure = axes.get_figure(root=True)
    if figure is not None:
        columns = min(len(handles), int(figure.get_figwidth() / _LEGEND_COLUMN))
        figure.legend(handles=list(handles), loc="outside lower center", ncols=columns)
