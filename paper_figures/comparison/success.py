"""Which trials of the comparison stay up, and what they survive, for each planner and controller."""

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from paper_figures.comparison.who_wins import COMPLETED, MEASURES
from paper_figures.comparison_variants import CONTROLLERS, PLANNERS, STUDY, artefact, short
from paper_figures.known_limits import known_limits, limit_text
from quadlab.analysis.artefact import Claim, Verdict
from quadlab.analysis.statistics import wilson_interval
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import paper_style
from quadlab.plotting.table_figure import TableText, table_figure
from quadlab.studies.report import success_share

SEEDS = 5
INTERVALS = "; ".join(
    f"{count} of {SEEDS}: {100.0 * interval.lower:.0f} to {100.0 * interval.upper:.0f} %"
    for count, interval in ((count, wilson_interval(count, SEEDS)) for count in range(SEEDS, -1, -1))
)
CAPTION = (
    f"ANYmal B, estimator ekf. Above: trials that stay up; Wilson's intervals of 95 %: {INTERVALS}. "
    "Below: smallest and median limit of the searches; for pushes over eight directions and two phases of the stride, "
    "for planks and steps over twelve places. Tracking errors, cost of transport and computing times of each line are "
    "in the table beside the figure. zmp_spline plans walks alone."
)
ARTEFACT = artefact("success", "Trials that stay up, and the largest disturbances survived", CAPTION)
COMBINATIONS = tuple((planner, controller) for planner in PLANNERS for controller in CONTROLLERS)
DIGITS = {"push": 2, "plank": 0, "step down": 0}
"""Behind the point of a limit, in its unit."""


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return the table: a line a disturbance and gait, a column a planner and controller."""
    table = numbers(results)
    groups = [lines for _, lines in table.groupby(["disturbance", "gait", "unit"], sort=False)]
    shares = sum(lines["unit"].iloc[0] == COMPLETED for lines in groups)
    planners = [name if controller == CONTROLLERS[0] else "" for name, controller in COMBINATIONS]
    header = (("", "", *planners), ("", "", *(short(controller) for _, controller in COMBINATIONS)))
    return table_figure(TableText(header, tuple(map(_line, groups)), rules=(shares - 1,), left=2))


def _line(rows: pd.DataFrame) -> tuple[str, ...]:
    """Return the line of a disturbance and gait: its name, the gait, and a cell a combination."""
    by_combination = {(row["planner"], row["controller"]): row for _, row in rows.iterrows()}
    first = rows.iloc[0]
    name = first["disturbance"] if first["unit"] == COMPLETED else first["unit"]
    return str(name), str(first["gait"]).replace("_", " "), *(_cell(by_combination.get(key)) for key in COMBINATIONS)


def _cell(line: "pd.Series[Any] | None") -> str:
    if line is None:
        return "-"
    if line["unit"] != COMPLETED:
        digits = DIGITS[str(line["disturbance"])]
        return f"{limit_text(line['minimum'], digits)} / {limit_text(line['median'], digits)}"
    return f"{line[COMPLETED]:.0f}/{line['trials']:.0f}"


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return one row a disturbance, gait, planner and controller.

    ``unit`` is "completed" for trials at one size, with their number, those that completed, and medians over these of
    errors, cost of transport and times; for limits it is their name and unit, with minimum, median and their number.
    """
    limits = known_limits(results, STUDY)
    table = results.table(STUDY)
    fixed = table[~table["disturbance"].isin(limits["disturbance"].unique())]
    return pd.concat([_shares(fixed), _limits(limits)], ignore_index=True)


def _shares(trials: pd.DataFrame) -> pd.DataFrame:
    by = ["disturbance", "gait", "planner", "controller"]
    outcomes = [measure.column for measure in MEASURES if not measure.searched and measure.column != COMPLETED]
    good = trials["status"] == "completed"
    shares = good.groupby([trials[name] for name in by], sort=False).agg(["size", "sum"])
    medians = trials[good].groupby(by, sort=False)[outcomes].median()
    joined = shares.rename(columns={"size": "trials", "sum": COMPLETED}).join(medians).reset_index()
    return joined.assign(unit=COMPLETED)


def _limits(limits: pd.DataFrame) -> pd.DataFrame:
    found = []
    for measure in (measure for measure in MEASURES if measure.searched):
        rows = limits[limits["disturbance"] == measure.disturbance]
        values = rows.assign(value=measure.scale * rows["limit"].fillna(0.0))
        groups = values.groupby(["disturbance", "gait", "planner", "controller"], sort=False)["value"]
        table = groups.agg(minimum="min", median="median", searches="size").reset_index()
        found.append(table.assign(unit=measure.name))
    return pd.concat(found, ignore_index=True)


def claims(results: StudyResults) -> list[Claim]:
    """Return how many trials each combination completes; the largest disturbances are claims of other figures."""
    table = numbers(results)
    shares = table[table["unit"] == COMPLETED]
    found = []
    for planner, controller in COMBINATIONS:
        rows = shares[(shares["planner"] == planner) & (shares["controller"] == controller)]
        ours = success_share(int(rows[COMPLETED].sum()), int(rows["trials"].sum()))
        found.append(Claim(f"{planner}, {controller}: trials that stay up", "-", ours, Verdict.NEW, _fallen(rows)))
    return found


def _fallen(rows: pd.DataFrame) -> str:
    lines = rows[rows[COMPLETED] < rows["trials"]]
    names = [f"{line['disturbance']}, {line['gait']}" for _, line in lines.iterrows()]
    return f"The others: {'; '.join(names)}." if names else ""
