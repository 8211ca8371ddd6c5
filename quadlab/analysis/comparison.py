"""Success and one metric by factors, and differences between the levels of a factor over equal conditions."""

from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd

from quadlab.analysis.statistics import Interval, paired_mean_difference, paired_share_difference, wilson_interval
from quadlab.errors import LogError
from quadlab.trials.problems import suggestion
from quadlab.trials.result import TrialStatus

SEED = "seed"
_BOTH = (SEED, "duration_s")
"""Values of the configuration that are columns of the result too."""
_MISSING = "none"


@dataclass(frozen=True)
class Group:
    """The trials with the same levels of the factors.

    Attributes:
        levels: one for each factor.
        success: share of trials that completed, with Wilson's interval.
        metric: values of the trials that completed and have it.
    """

    levels: tuple[str, ...]
    success: Interval
    metric: tuple[float, ...]


@dataclass(frozen=True)
class PairedComparison:
    """Two levels of a factor over the conditions that both were tried in.

    Attributes:
        first, second: the levels.
        success: share of the second minus that of the first, with Bonett and Price's interval.
        metric: second minus first over the pairs in which both completed, with Student's interval.
        unpaired: trials of either level without a partner; they are left out.
    """

    first: str
    second: str
    success: Interval
    metric: Interval
    unpaired: int


def levels_of(table: pd.DataFrame, factor: str) -> "pd.Series[str]":
    """Return the level of each trial as text.

    Args:
        table: of ``collect_trials``.
        factor: a column: a field of the result such as ``controller``, or a dotted key of the configuration that
            differs between the trials.

    Raises:
        LogError: if there is no such column.
    """
    if factor not in table:
        raise LogError(f"'{factor}' is no column, or the same in all trials; {suggestion(factor, table.columns)}")
    column = table[factor]
    return column.astype("string").fillna(_MISSING).astype(str)


def metric_of(table: pd.DataFrame, metric: str) -> "pd.Series[float]":
    """Return a numerical column.

    Raises:
        LogError: if there is none of that name.
    """
    numbers = [name for name in table.columns if pd.api.types.is_numeric_dtype(table[name])]
    if metric not in numbers:
        raise LogError(f"'{metric}' is no numerical column; {suggestion(metric, numbers)}")
    return table[metric].astype("Float64").astype(float)


def grouped(table: pd.DataFrame, factors: Sequence[str], metric: str) -> list[Group]:
    """Return the groups of all combinations of levels that exist, sorted.

    Args:
        table: of ``collect_trials``.
        factors: columns.
        metric: a numerical column.

    Raises:
        LogError: if a column does not exist.
    """
    levels = pd.DataFrame({factor: levels_of(table, factor) for factor in factors})
    completed, values = _completed(table), metric_of(table, metric)
    groups = []
    for key, rows in levels.groupby(list(factors)):
        done = completed[rows.index]
        success = wilson_interval(int(done.sum()), len(rows))
        numbers = values[rows.index][done].dropna()
        groups.append(Group(tuple(map(str, key)), success, tuple(float(number) for number in numbers)))
    return groups


def paired(table: pd.DataFrame, factor: str, metric: str, baseline: str | None = None) -> list[PairedComparison]:
    """Compare every level of ``factor`` with the baseline over the same seeds and conditions.

    A condition is everything that differs between trials but what belongs to the factor: keys of the same part of the
    configuration that have one value within each of its levels.

    Args:
        table: of ``collect_trials``.
        factor: a column.
        metric: a numerical column.
        baseline: a level; the first by default.

    Raises:
        LogError: if a column or the baseline does not exist, or a level was tried twice in the same condition.
    """
    levels, values, completed = levels_of(table, factor), metric_of(table, metric), _completed(table)
    names = sorted(levels.unique())
    first = names[0] if baseline is None else baseline
    if first not in names:
        raise LogError(f"'{first}' is no level of {factor}; {suggestion(first, names)}")
    frame = pd.DataFrame({"level": levels, "condition": _conditions(table, factor, levels)})
    frame["completed"], frame["metric"] = completed, values
    twice = frame[frame.duplicated(["level", "condition"])]
    if len(twice):
        row = twice.iloc[0]
        raise LogError(f"{factor}={row['level']} was tried more than once with {row['condition']}; select some trials")
    frames = {name: rows.set_index("condition") for name, rows in frame.groupby("level")}
    return [_compare(first, frames[first], name, frames[name]) for name in names if name != first]


def conditions_between(table: pd.DataFrame, factor: str, levels: "pd.Series[str]") -> list[str]:
    """Return the columns that tell the conditions apart in which the levels of a factor are compared.

    What is logged, and into which folder, is none of them.
    """
    part = factor.split(".", maxsplit=1)[0]
    keys = [name for name in table.columns if "." in name and not name.startswith("log.")]
    return [name for name in (*keys, *_BOTH) if name != factor and not _belongs(table, name, part, levels)]


def _belongs(table: pd.DataFrame, name: str, part: str, levels: "pd.Series[str]") -> bool:
    """Whether a column is of the factor's part of the configuration and has one value within each of its levels."""
    if name.split(".", maxsplit=1)[0] != part or name == SEED:
        return False
    pairs = pd.DataFrame({"level": levels, "value": levels_of(table, name)}).drop_duplicates()
    return not pairs["level"].duplicated().any()


def _conditions(table: pd.DataFrame, factor: str, levels: "pd.Series[str]") -> "pd.Series[str]":
    columns = [f"{name}=" + levels_of(table, name) for name in conditions_between(table, factor, levels)]
    text = columns[0]
    for column in columns[1:]:
        text = text + " " + column
    return text


def _compare(first: str, one: pd.DataFrame, second: str, other: pd.DataFrame) -> PairedComparison:
    pairs = one.merge(other, left_index=True, right_index=True, suffixes=("_first", "_second"))
    a, b = pairs["completed_first"].astype(bool), pairs["completed_second"].astype(bool)
    success = paired_share_difference(int((a & ~b).sum()), int((b & ~a).sum()), len(pairs))
    both = pairs[a & b].dropna(subset=["metric_first", "metric_second"])
    metric = paired_mean_difference(both["metric_first"].to_numpy(float), both["metric_second"].to_numpy(float))
    return PairedComparison(first, second, success, metric, len(one) + len(other) - 2 * len(pairs))


def _completed(table: pd.DataFrame) -> "pd.Series[bool]":
    return (table["status"] == TrialStatus.COMPLETED.value).astype(bool)
