"""Two levels of a factor on the same conditions."""

from collections.abc import Sequence

import pandas as pd

from quadlab.analysis.statistics import Interval, paired_mean_difference


def pairs(table: pd.DataFrame, factor: str, levels: tuple[str, str], same: Sequence[str], column: str) -> pd.DataFrame:
    """Return a column for both levels side by side, one row a condition that has both.

    Conditions of which a column says nothing, because another block of the study varies it, agree in that column.

    Args:
        table: one row a job.
        factor: column of the levels.
        levels: first and second.
        same: columns in which a pair agrees.
        column: to compare.
    """
    chosen = table[table[factor].isin(levels)]
    chosen = chosen.assign(**{name: chosen[name].astype(str).where(chosen[name].notna(), "") for name in same})
    wide = chosen.pivot_table(index=list(same), columns=factor, values=column, aggfunc="first", observed=True)
    return wide.reindex(columns=list(levels)).dropna()


def mean_difference(
    table: pd.DataFrame, factor: str, levels: tuple[str, str], same: Sequence[str], column: str
) -> Interval:
    """Return the mean of second minus first over pairs with its 95 % interval; see ``pairs``."""
    wide = pairs(table, factor, levels, same, column)
    return paired_mean_difference(wide[levels[0]].to_numpy(float), wide[levels[1]].to_numpy(float))
