"""The text that a study leaves for people: one line a group of jobs."""

from collections.abc import Iterator, Sequence

import pandas as pd

from quadlab.analysis.statistics import wilson_interval
from quadlab.studies.config import StudyConfig
from quadlab.studies.progress import GOOD
from quadlab.trials.result import TrialStatus


def study_report(study: StudyConfig, table: pd.DataFrame, limits: pd.DataFrame) -> str:
    """Return title and tables in Markdown.

    Args:
        study: names the factors of the lines and the columns that are shown.
        table: one row a job.
        limits: one row a search; may be empty.
    """
    parts = [f"# {study.title}", "", *_success_lines(study, table)]
    if len(limits):
        parts += ["", *_limit_lines(study, limits)]
    return "\n".join(parts) + "\n"


def success_share(good: int, trials: int) -> str:
    """Return "good of trials (lower to upper %)" with the 95 % interval of Wilson; errors are no trials."""
    interval = wilson_interval(good, trials)
    return f"{good} of {trials} ({100 * interval.lower:.0f} to {100 * interval.upper:.0f} %)"


def _success_lines(study: StudyConfig, table: pd.DataFrame) -> Iterator[str]:
    names = [name for name in study.report_by if name in table]
    shown = [column for column in study.report_columns if column in table]
    yield _line([*names, "completed (95 %)", *(f"{column}, median / max" for column in shown), "failures"])
    yield _rule(len(names), 1 + len(shown), 1)
    for key, rows in _groups(table, names):
        good = rows["status"].isin(GOOD)
        known = int((rows["status"] != TrialStatus.ERROR.value).sum())  # errors say nothing about the robot
        numbers = [_median_and_max(rows.loc[good, column]) for column in shown]
        yield _line([*key, success_share(int(good.sum()), known), *numbers, _failures(rows[~good])])


def _limit_lines(study: StudyConfig, limits: pd.DataFrame) -> Iterator[str]:
    names = [name for name in study.report_by if name in limits]
    columns = ["minimum", "median", "maximum", "above the grid", "not monotone"]
    unknown = limits["unknown"].notna() if "unknown" in limits else pd.Series(False, limits.index)
    shown = ["unknown"] if unknown.any() else []
    yield _line([*names, "largest survived", "searches", *shown, *columns])
    yield _rule(len(names) + 1, 1 + len(shown) + len(columns), 0)
    for key, rows in _groups(limits, [*names, "key"]):
        missing = [str(int(unknown[rows.index].sum())) for _ in shown]
        yield _line([*key, str(len(rows)), *missing, *_limit_numbers(rows[~unknown[rows.index]])])


def _limit_numbers(rows: pd.DataFrame) -> list[str]:
    """Return minimum, median, maximum, how many survived all of the grid, and how many of those confirmed are odd."""
    if not len(rows):
        return ["-"] * 5
    found = rows["limit"].astype(float)
    least = "none" if found.isna().any() else f"{found.min():.4g}"
    known = found.fillna(0.0)
    above = int((found >= rows["highest"]).sum())
    confirmed = rows["monotone"].dropna().astype(bool)
    odd = f"{int((~confirmed).sum())} of {len(confirmed)}" if len(confirmed) else "-"
    return [least, f"{known.median():.4g}", f"{known.max():.4g}", str(above), odd]


def _groups(table: pd.DataFrame, names: Sequence[str]) -> Iterator[tuple[list[str], pd.DataFrame]]:
    if not names:
        yield [], table
        return
    for key, rows in table.astype(dict.fromkeys(names, str)).groupby(list(names), sort=False):
        yield [str(value) for value in key], table.loc[rows.index]


def _median_and_max(values: "pd.Series[float]") -> str:
    return f"{values.median():.3g} / {values.max():.3g}" if values.notna().any() else "-"


def _failures(rows: pd.DataFrame) -> str:
    if not len(rows):
        return "-"
    counts = rows["status"].value_counts()
    return ", ".join(f"{count} {status}" for status, count in counts.items())


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _rule(left: int, right: int, last: int) -> str:
    return f"|{'---|' * left}{'--:|' * right}{'---|' * last}"
