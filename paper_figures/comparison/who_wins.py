"""Which controller, which planner: differences over pairs with the same everything else."""

from collections.abc import Iterator
from dataclasses import dataclass

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper_figures.comparison_variants import QUESTIONS, STUDY, Question, artefact
from paper_figures.known_limits import known_limits
from paper_figures.push_limits import ANYMAL_KG, PUSH_S
from quadlab.analysis.artefact import Claim, Verdict
from quadlab.analysis.paired import pairs
from quadlab.analysis.statistics import CONFIDENCE, holm_adjusted, paired_mean_difference, sign_flip_probability
from quadlab.analysis.study_results import StudyResults
from quadlab.errors import LogError
from quadlab.plotting.style import NEUTRAL, SERIES, TEXT_WIDTH, paper_style

RELEVANT_PERCENT = 2.0
"""Smaller differences, in per cent of the first one's mean or points of a share, matter to nobody."""
CAPTION = (
    "Mean differences over conditions (disturbance, gait, seed, or direction and place of a search for a limit), each "
    "the mean over planners (kinematic_sqp and vertex_zmp) or over all controllers, in per cent of the mean of the one "
    "that is subtracted, of completed trials in points; estimator ekf. Axis linear within the grey band of 2 %, "
    "logarithmic beyond. Intervals of 95 %, not corrected for their number; coloured if the mean leaves the band and a "
    "permutation test over the pairs, corrected for all rows by Holm's method, says so at 5 %: blue where the one "
    "named last in the title is better, orange the one named first. Errors, cost of transport and times are those of "
    "conditions that all variants of a question completed. Places of planks and steps, 2 cm apart, count as "
    "independent. zmp_spline plans walks alone."
)
ARTEFACT = artefact("differences", "Which controller, which planner", CAPTION)
TICKS_PERCENT = (-100, -10, -2, 0, 2, 10, 100)


@dataclass(frozen=True)
class Measure:
    """Something in which variants are compared.

    Attributes:
        name: with its unit.
        column: of the table.
        larger_is_better: direction.
        scale: from the column's unit.
        disturbance: rows that count; all if empty.
        by_gait: whether each gait stands for itself, since gaits differ in it.
        searched: whether it is a limit that was searched for.
        factor: of the questions that it answers; of all if empty.
    """

    name: str
    column: str
    larger_is_better: bool
    scale: float = 1.0
    disturbance: str = ""
    by_gait: bool = False
    searched: bool = False
    factor: str = ""


COMPLETED = "completed"
"""Column of 1 for trials that stayed up and 0 for others."""
MEASURES = (
    Measure("completed trials [%]", COMPLETED, True, 100.0),
    Measure("largest push [m/s]", "limit", True, PUSH_S / ANYMAL_KG, "push", searched=True),
    Measure("highest plank [cm]", "limit", True, 100.0, "plank", searched=True),
    Measure("deepest step down [cm]", "limit", True, 100.0, "step down", searched=True),
    Measure("largest CoM error [mm]", "com_error_max_mm", False, by_gait=True),
    Measure("roll and pitch, rms [deg]", "roll_pitch_rms_deg", False),
    Measure("cost of transport [-]", "cost_of_transport", False, by_gait=True),
    Measure("planning [ms]", "planning_solve_ms", False, factor="planner"),
    Measure("control tick, median [µs]", "control_tick_median_us", False, factor="controller"),
)
KEYS = ("disturbance", "gait", "direction", "scenario.pushes.0.start_s", "scenario.terrain.0.center_x_m",
        "scenario.terrain.0.edge_x_m", "seed")  # fmt: skip


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return relative differences with their 95 % intervals, one row a measure and one panel a question."""
    table = numbers(results)
    figure = Figure(figsize=(TEXT_WIDTH, 5.0), layout="constrained")
    factors = list(dict.fromkeys(question.factor for question in QUESTIONS))
    panels = figure.subplots(len(factors), len(QUESTIONS) // len(factors), sharex=True, sharey="row")
    for line, factor in zip(panels, factors, strict=True):
        asked_here = [question for question in QUESTIONS if question.factor == factor]
        rows = [_rows_of(table, question) for question in asked_here]
        names = list(dict.fromkeys(pd.concat(rows)["measure"]))
        for axes, question, answers in zip(line, asked_here, rows, strict=True):
            axes.set_title(question.text)
            for _, row in answers.iterrows():
                _draw_difference(axes, names.index(str(row["measure"])), row)
            _style_axis(axes)
        line[0].set_yticks(range(len(names)), names)
        line[0].invert_yaxis()
    figure.supxlabel(
        "mean difference [%]; blue: the one named last is better, orange: the one named first, grey: no clear one",
        size=8,
    )
    return figure


def _rows_of(table: pd.DataFrame, question: Question) -> pd.DataFrame:
    return table[(table["first"] == question.first) & (table["second"] == question.second)]


def _draw_difference(axes: Axes, place: int, row: "pd.Series[float]") -> None:
    estimate, lower, upper = (float(row[f"{name}_percent"]) for name in ("difference", "lower", "upper"))
    better = better_of(row)
    colour = NEUTRAL if better is None else SERIES[1] if better == str(row["first"]) else SERIES[2]
    axes.errorbar(
        [estimate], [place], xerr=[[estimate - lower], [upper - estimate]], fmt="o", color=colour, capsize=2, ms=3.5
    )


def _style_axis(axes: Axes) -> None:
    axes.axvspan(-RELEVANT_PERCENT, RELEVANT_PERCENT, color="#eeeeee", zorder=0)
    axes.axvline(0.0, color=SERIES[0], linewidth=0.6)
    axes.set_xscale("symlog", linthresh=RELEVANT_PERCENT, linscale=0.7)
    axes.set_xlim(-150, 150)
    axes.set_xticks(TICKS_PERCENT, [f"{tick:+d}" if tick else "0" for tick in TICKS_PERCENT])
    axes.minorticks_off()
    axes.tick_params(axis="y", length=0.0)
    axes.grid(visible=True, axis="y", linewidth=0.3)


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return one row a question and measure: means of both, difference, its 95 % interval, and how clear it is.

    ``probability`` is that of the test of signs, ``corrected`` the same for all rows together by Holm's method;
    ``..._percent`` are relative to the mean of the first, those of the completed trials are points.
    """
    limits = known_limits(results, STUDY)
    table = pd.DataFrame(list(_rows(results.table(STUDY), limits)))
    return table.assign(corrected=holm_adjusted(table["probability"].to_numpy(float)))


def _rows(table: pd.DataFrame, limits: pd.DataFrame) -> Iterator[dict[str, object]]:
    tracked = table[~table["disturbance"].isin(limits["disturbance"].unique())]
    tracked = tracked.assign(**{COMPLETED: (tracked["status"] == "completed").astype(float)})
    good, survived = tracked[tracked[COMPLETED] > 0.0], limits.fillna({"limit": 0.0})
    for question in QUESTIONS:
        for measure in (measure for measure in MEASURES if measure.factor in ("", question.factor)):
            source = survived if measure.searched else tracked if measure.column == COMPLETED else good
            for name, rows in _parts(asked(source, question), measure):
                scaled = rows.assign(**{measure.column: measure.scale * rows[measure.column]})
                yield row_of(question, name, measure, scaled)


def asked(table: pd.DataFrame, question: Question) -> pd.DataFrame:
    """Return the rows of a question; gaits that one of the two cannot do are none of its conditions."""
    both = table[table[question.factor].isin((question.first, question.second))]
    both = both[both[question.other].isin(question.over)]
    able = both.groupby(["disturbance", "gait"])[question.factor].transform("nunique")
    return both[able == len((question.first, question.second))]


def _parts(source: pd.DataFrame, measure: Measure) -> Iterator[tuple[str, pd.DataFrame]]:
    """Return the rows that count for a measure, gait by gait if gaits stand for themselves, and how that is called."""
    chosen = source[source["disturbance"] == measure.disturbance] if measure.disturbance else source
    if chosen.empty:
        return
    if not measure.by_gait:
        yield measure.name, chosen
        return
    for gait, rows in chosen.groupby("gait", sort=False):
        yield f"{measure.name}, {str(gait).replace('_', ' ')}", rows


def averaged(table: pd.DataFrame, question: Question, column: str) -> tuple[pd.DataFrame, list[str]]:
    """Return the mean of ``column`` over the levels of the other factor, and the columns that make a condition.

    There is one row a condition and level of the factor in question.

    Trials that differ in the other factor alone are no independent ones: counted singly they would make intervals too
    narrow. Conditions in which a value is missing at one of its levels are left out.
    """
    keys = [key for key in KEYS if key in table]
    known = table.assign(**{key: table[key].astype(str).where(table[key].notna(), "") for key in keys})
    groups = known.groupby([*keys, question.factor], observed=True)[column]
    means = groups.agg(["mean", "count"]).reset_index().rename(columns={"mean": column})
    return means[means["count"] == len(question.over)], keys


def row_of(question: Question, name: str, measure: Measure, rows: pd.DataFrame) -> dict[str, object]:
    """Return what ``numbers`` says of a question and a measure, before the correction for the number of rows.

    Raises:
        LogError: if there is no pair.
    """
    levels = question.first, question.second
    means, same = averaged(rows, question, measure.column)
    wide = pairs(means, question.factor, levels, same, measure.column)
    if wide.empty:
        raise LogError(
            f"{STUDY}: no pair to tell '{name}' of {question.text}; "
            f"python experiments/run_study.py {STUDY} runs what is missing"
        )
    first, second = wide[levels[0]].to_numpy(float), wide[levels[1]].to_numpy(float)
    difference = paired_mean_difference(first, second)
    to_percent = 1.0 if measure.column == COMPLETED else 100.0 / first.mean()
    kinds = wide.index.to_frame()[["disturbance", "gait"]].agg(", ".join, axis=1)
    differing = kinds[first != second]
    return {
        "first": question.first,
        "second": question.second,
        "measure": name,
        "first_mean": first.mean(),
        "second_mean": second.mean(),
        "difference": difference.estimate,
        "lower": difference.lower,
        "upper": difference.upper,
        "difference_percent": to_percent * difference.estimate,
        "lower_percent": to_percent * difference.lower,
        "upper_percent": to_percent * difference.upper,
        "pairs": difference.count,
        "probability": sign_flip_probability(first, second),
        "larger_is_better": measure.larger_is_better,
        "differing": len(differing),
        "only_in": differing.iloc[0] if differing.nunique() == 1 < kinds.nunique() else "",
        "not_monotone": int((rows["monotone"] == False).sum()) if measure.searched else 0,  # noqa: E712 - or missing
    }


def better_of(row: "pd.Series[float]") -> str | None:
    """Return which of the two is better, or None if that is not clear or does not matter."""
    estimate = float(row["difference_percent"])
    if not (float(row["corrected"]) < 1.0 - CONFIDENCE and abs(estimate) > RELEVANT_PERCENT):
        return None
    return str(row["second"] if (estimate > 0.0) == bool(row["larger_is_better"]) else row["first"])


def claims(results: StudyResults) -> list[Claim]:
    """Return one line a question and measure: who is better, if anyone."""
    return [_claim(row) for _, row in numbers(results).iterrows()]


def _claim(row: "pd.Series[float]") -> Claim:
    lower, upper, estimate = float(row["lower"]), float(row["upper"]), float(row["difference"])
    ours = (
        f"{estimate:+.3g} ({lower:+.3g} to {upper:+.3g}) of {float(row['first_mean']):.3g}, {row['pairs']} pairs, "
        f"p = {float(row['corrected']):.2g}"
    )
    return Claim(
        f"{row['measure']}: {row['second']} minus {row['first']}", "-", ours, Verdict.NEW, " ".join(_remarks(row))
    )


def _remarks(row: "pd.Series[float]") -> Iterator[str]:
    better = better_of(row)
    if better is not None:
        yield f"{better} is better."
    elif float(row["corrected"]) < 1.0 - CONFIDENCE:
        yield f"Clear, but less than {RELEVANT_PERCENT:g} %."
    else:
        yield "No clear difference."
    if row["only_in"]:
        yield f"All {row['differing']} pairs that differ are of one kind: {row['only_in']}."
    if row["not_monotone"]:
        yield f"Below {row['not_monotone']} of the limits a smaller value was not survived."
