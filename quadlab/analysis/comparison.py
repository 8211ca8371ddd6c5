"""Success and one metric by factors, and differences between the levels of a factor over equal conditions."""

from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd

from quadlab.analysis.factors import SEED, VALUES, baseline_of, level_order, levels_of, metric_of, texts_of
from quadlab.analysis.statistics import Interval, paired_mean_difference, paired_share_difference, wilson_interval
from quadlab.errors import LogError
from quadlab.trials.result import TrialStatus


@dataclass(frozen=True)
class Group:
    """The trials with the same levels of the factors.

    Attributes:
        levels: one for each factor.
        success: share of trials that completed, with Wilson's interval; where the program failed nothing is known of
            success, so that these trials do not count.
        metric: values of the trials that completed and have it.
        errors: number of trials in which the program failed.
    """

    levels: tuple[str, ...]
    success: Interval
    metric: tuple[float, ...]
    errors: int = 0


@dataclass(frozen=True)
class PairedComparison:
    """Two levels of a factor over the conditions that both were tried in.

    Attributes:
        first, second: the levels.
        success: share of the second minus that of the first, with Bonett and Price's interval.
        metric: second minus first over the pairs in which both completed, with Student's interval.
        unpaired: trials of either level without a partner, or whose partner ended in an error; they are left out.
    """

    first: str
    second: str
    success: Interval
    metric: Interval
    unpaired: int


def grouped(table: pd.DataFrame, factors: Sequence[str], metric: str) -> list[Group]:
    """Return the groups of all combinations of levels that exist, sorted.

    Args:
        table: of ``collect_trials``.
        factors: one or two, see ``levels_of``.
        metric: see ``metric_of``.

    Raises:
        LogError: if the factors or the metric are none.
    """
    if len(set(factors)) < len(factors):
        raise LogError(f"'{factors[0]}' is named twice; expected two factors")
    levels = pd.DataFrame({factor: levels_of(table, factor) for factor in factors})
    values = metric_of(table, metric)
    groups = [
        _group(tuple(map(str, key)), table.loc[rows.index, "status"], values[rows.index])
        for key, rows in levels.groupby(list(factors))
    ]
    return sorted(groups, key=lambda group: tuple(map(level_order, group.levels)))


def _group(levels: tuple[str, ...], status: "pd.Series[str]", values: "pd.Series[float]") -> Group:
    done, errors = _is(status, TrialStatus.COMPLETED), int(_is(status, TrialStatus.ERROR).sum())
    success = wilson_interval(int(done.sum()), len(status) - errors)
    return Group(levels, success, tuple(float(number) for number in values[done].dropna()), errors)


def paired(table: pd.DataFrame, factor: str, metric: str, baseline: str | None = None) -> list[PairedComparison]:
    """Compare every level of ``factor`` with the baseline over the same seeds and conditions.

    A condition is everything that differs between trials but what belongs to the factor: keys of the same part of the
    configuration that have one value within each of its levels.

    Args:
        table: of ``collect_trials``.
        factor: see ``levels_of``.
        metric: see ``metric_of``.
        baseline: a level; the first by default.

    Raises:
        LogError: if factor, metric or baseline are none, or a level was tried twice in the same condition.
    """
    levels, values = levels_of(table, factor), metric_of(table, metric)
    names = sorted(levels.unique(), key=level_order)
    first = baseline_of(factor, names, baseline)
    frame = pd.DataFrame({"level": levels, "condition": _conditions(table, factor, levels)})
    frame["completed"], frame["metric"] = _is(table["status"], TrialStatus.COMPLETED), values
    frame = frame[~_is(table["status"], TrialStatus.ERROR)]
    twice = frame[frame.duplicated(["level", "condition"])]
    if len(twice):
        row = twice.iloc[0]
        raise LogError(f"{factor}={row['level']} was tried more than once with {row['condition']}; select some trials")
    frames = {name: frame[frame["level"] == name].set_index("condition") for name in names}
    return [_compare(first, frames[first], name, frames[name]) for name in names if name != first]


def conditions_between(table: pd.DataFrame, factor: str, levels: "pd.Series[str]") -> list[str]:
    """Return the columns that tell the conditions apart in which the levels of a factor are compared.

    What is logged, and into which folder, is none of them.
    """
    part = factor.split(".", maxsplit=1)[0]
    keys = [name for name in table.columns if "." in name and not name.startswith("log.")]
    return [name for name in (*keys, *VALUES) if name != factor and not _belongs(table, name, part, levels)]


def _belongs(table: pd.DataFrame, name: str, part: str, levels: "pd.Series[str]") -> bool:
    """Whether a column is of the factor's part of the configuration and has one value within each of its levels."""
    if name.split(".", maxsplit=1)[0] != part or name == SEED:
        return False
    pairs = pd.DataFrame({"level": levels, "value": texts_of(table[name])}).drop_duplicates()
    return not pairs["level"].duplicated().any()


def _conditions(table: pd.DataFrame, factor: str, levels: "pd.Series[str]") -> "pd.Series[str]":
    columns = [f"{name}=" + texts_of(table[name]) for name in conditions_between(table, factor, levels)]
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


def _is(status: "pd.Series[str]", wanted: TrialStatus) -> "pd.Series[bool]":
    return (status == wanted.value).astype(bool)
