"""Comparisons as tables."""

import math
from collections.abc import Callable, Sequence

import pandas as pd

from quadlab.analysis.comparison import Group, PairedComparison
from quadlab.analysis.factors import level_order
from quadlab.analysis.statistics import Interval
from quadlab.analysis.text_table import TextTable

NONE = "-"


def success_table(groups: Sequence[Group], factors: Sequence[str]) -> TextTable:
    """Return shares of completed trials with their 95 % intervals; a second factor goes into the columns.

    Where the program failed, how often stands beside the share.
    """
    return _pivot(groups, factors, "completed", _share_and_errors)


def metric_table(groups: Sequence[Group], factors: Sequence[str], metric: str) -> TextTable:
    """Return median and worst value of a metric over the completed trials; a second factor goes into the columns."""
    return _pivot(groups, factors, f"{metric}, median / max", lambda group: _median_and_max(group.metric))


def paired_table(comparisons: Sequence[PairedComparison], factor: str, metric: str) -> TextTable:
    """Return differences over equal conditions with their 95 % intervals."""
    numbers = ("completed, difference", "pairs", f"{metric}, difference", "pairs completed", "without partner")
    rows = [
        (
            comparison.second,
            comparison.first,
            difference_text(comparison.success, 100.0, " %"),
            str(comparison.success.count),
            difference_text(comparison.metric, 1.0, ""),
            str(comparison.metric.count),
            str(comparison.unpaired),
        )
        for comparison in comparisons
    ]
    return TextTable((factor, "minus", *numbers), tuple(rows), labels=2)


def share_text(share: Interval) -> str:
    """Return e.g. "9 of 10 (60 to 98 %)"."""
    if share.count == 0:
        return NONE
    successes = round(share.estimate * share.count)
    return f"{successes} of {share.count} ({100 * share.lower:.0f} to {100 * share.upper:.0f} %)"


def difference_text(interval: Interval, scale: float, unit: str) -> str:
    """Return e.g. "+0.3 (-0.1 to +0.7)"."""
    if math.isnan(interval.estimate):
        return NONE
    bounds = "" if math.isnan(interval.lower) else f" ({scale * interval.lower:+.3g} to {scale * interval.upper:+.3g})"
    return f"{scale * interval.estimate:+.3g}{unit}{bounds}"


def _pivot(groups: Sequence[Group], factors: Sequence[str], what: str, text: Callable[[Group], str]) -> TextTable:
    cell = {group.levels: text(group) for group in groups}
    if len(factors) == 1:
        return TextTable((factors[0], what), tuple((levels[0], shown) for levels, shown in cell.items()), labels=1)
    rows = list(dict.fromkeys(levels[0] for levels in cell))
    columns = sorted({levels[1] for levels in cell}, key=level_order)
    header = (f"{what}: {factors[0]}", *(f"{factors[1]}={column}" for column in columns))
    return TextTable(header, tuple((r, *(cell.get((r, c), NONE) for c in columns)) for r in rows), labels=1)


def _share_and_errors(group: Group) -> str:
    share = share_text(group.success)
    return f"{share}, {group.errors} error{'s' if group.errors > 1 else ''}" if group.errors else share


def _median_and_max(values: Sequence[float]) -> str:
    if not values:
        return NONE
    series = pd.Series(values)
    return f"{series.median():.3g} / {series.max():.3g}"
