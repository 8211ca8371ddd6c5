"""Columns of the table of trials: as a factor with levels in their order, and as a metric."""

import math
from typing import Any

import pandas as pd

from quadlab.errors import LogError
from quadlab.trials.problems import did_you_mean, suggestion
from quadlab.trials.result import TrialResult

SEED = "seed"
VALUES = (SEED, "duration_s")
"""Values of the configuration that are columns of the result too."""
PARTS = ("robot", "gait", "planner", "controller", "estimator", "scenario")
OUTCOMES = tuple(
    name for name in TrialResult.model_fields if name not in (*PARTS, *VALUES, "schema_version", "trial_id")
)
_MISSING = "none"


def levels_of(table: pd.DataFrame, factor: str) -> "pd.Series[str]":
    """Return the level of each trial as text.

    Args:
        table: of ``collect_trials``.
        factor: a part such as ``controller``, ``seed``, ``duration_s``, or a dotted key of the configuration that
            differs between the trials.

    Raises:
        LogError: if that is no factor, or has one level alone.
    """
    factors = [name for name in table.columns if name in PARTS or name in VALUES or "." in name]
    if factor not in factors:
        what = "an outcome, no factor" if factor in OUTCOMES else "no factor, or the same in all trials"
        known = f"{', '.join(PARTS + VALUES)}, or a dotted key, see the header of trials.csv"
        raise LogError(f"'{factor}' is {what}; {did_you_mean(factor, factors)}known: {known}")
    levels = texts_of(table[factor])
    if levels.nunique() < 2:
        raise LogError(f"{factor} is '{levels.iloc[0]}' in all trials, there is nothing to compare")
    return levels


def metric_of(table: pd.DataFrame, metric: str) -> "pd.Series[float]":
    """Return an outcome that is a number.

    Raises:
        LogError: if there is none of that name.
    """
    numbers = [name for name in OUTCOMES if pd.api.types.is_numeric_dtype(table[name])]
    if metric not in numbers:
        raise LogError(f"'{metric}' is no outcome that is a number; {suggestion(metric, numbers)}")
    return table[metric].astype("Float64").astype(float)


def texts_of(column: "pd.Series[Any]") -> "pd.Series[str]":
    """Return the values of a column as words, e.g. "400" for 400.0; different values give different words."""
    return pd.Series([_text(value) for value in column], index=column.index, dtype=object)


def level_order(level: str) -> tuple[int, float, str]:
    """Return the key by which levels are sorted: numbers by value, then words, then what has none."""
    number = _number(level)
    if number is not None:
        return 0, number, level
    return 2 if level == _MISSING else 1, 0.0, level


def baseline_of(factor: str, names: list[str], baseline: str | None) -> str:
    """Return the level that is meant: the first by default, and a number however it is written.

    Raises:
        LogError: if there is no such level.
    """
    if baseline is None:
        return names[0]
    number = _number(baseline)
    same = [name for name in names if name == baseline or (number is not None and _number(name) == number)]
    if not same:
        raise LogError(f"'{baseline}' is no level of {factor}; {suggestion(baseline, names)}")
    return same[0]


def _text(value: Any) -> str:
    if pd.isna(value):
        return _MISSING
    if isinstance(value, float):
        short = f"{value:.12g}"
        return short if float(short) == value else repr(float(value))
    return str(value)


def _number(text: str) -> float | None:
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None
