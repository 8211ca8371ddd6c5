"""Success and a metric by factors, for a column of a paper."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.analysis.comparison import Group
from quadlab.analysis.factors import level_order
from quadlab.geometry.rotations import Array
from quadlab.plotting.style import COLUMN_WIDTH, SERIES, paper_style

_HEIGHT = 3.4  # [in]
_SPREAD = 0.7  # of the room between two levels that the columns of one of them share


def comparison_figure(groups: Sequence[Group], factors: Sequence[str], metric: str) -> Figure:
    """Return a figure with the share of completed trials above and the metric of those trials below.

    Args:
        groups: of ``comparison.grouped``.
        factors: one or two; the first along the axis, the second by colour.
        metric: name of the metric.
    """
    with paper_style():
        figure = Figure(figsize=(COLUMN_WIDTH, _HEIGHT), layout="constrained")
        success, values = figure.subplots(2, 1, sharex=True)
        levels = list(dict.fromkeys(group.levels[0] for group in groups))
        series = sorted({group.levels[1:] for group in groups}, key=lambda key: tuple(map(level_order, key)))
        for number, key in enumerate(series):
            chosen = [group for group in groups if group.levels[1:] == key and group.success.count]
            offset = _SPREAD * ((number + 0.5) / len(series) - 0.5)
            places = np.array([levels.index(group.levels[0]) + offset for group in chosen])
            colour = SERIES[number % len(SERIES)]
            _draw_success(success, places, chosen, colour, f"{factors[-1]}={key[0]}" if key else None)
            _draw_metric(values, places, chosen, colour)
        success.set(ylabel="completed [%]", ylim=(-4, 104))
        values.set(ylabel=metric.replace("_", " "), xlabel=factors[0])
        values.set_xticks(range(len(levels)), levels)
        if len(series) > 1:
            figure.legend(loc="outside upper center", ncols=min(len(series), 3))
    return figure


def _draw_success(axes: Axes, places: Array, groups: Sequence[Group], colour: str, label: str | None) -> None:
    shares = np.array([100.0 * group.success.estimate for group in groups])
    lower = shares - [100.0 * group.success.lower for group in groups]
    upper = np.array([100.0 * group.success.upper for group in groups]) - shares
    axes.errorbar(places, shares, (lower, upper), fmt="o", markersize=3, capsize=2, color=colour, label=label)


def _draw_metric(axes: Axes, places: Array, groups: Sequence[Group], colour: str) -> None:
    for place, group in zip(places, groups, strict=True):
        axes.plot([place] * len(group.metric), group.metric, "o", markersize=1.5, alpha=0.5, color=colour)
        if group.metric:
            axes.plot(place, np.median(group.metric), "_", markersize=9, color=colour)
