"""Two levels of a factor on the same conditions."""

from collections.abc import Sequence

import pandas as pd


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
