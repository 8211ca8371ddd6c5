"""Winkler 2017, V-A.1: the walk of Table I with and without the robustness cost, tracked under disturbances."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from paper_figures.trial_claims import completed, share
from quadlab.analysis.artefact import Artefact, Claim, Verdict, verdict
from quadlab.analysis.statistics import wilson_interval
from quadlab.analysis.study_results import StudyResults
from quadlab.analysis.support_margin import POLYGON_FEET, standing_feet, support_margins
from quadlab.planners.plan import MotionPlan
from quadlab.plotting.placed_plan import in_plan_frame
from quadlab.plotting.style import COP, GROUND, MEASURED, TEXT_WIDTH, paper_style

STUDY = "winkler2017_robustness"
ARTEFACT = Artefact("W-X2", "Winkler 2017, V-A.1", "Walk with and without the robustness cost", (STUDY,))
COSTS = {"robustness": "robustness cost", "acceleration": "CoM acceleration instead", "none": "no cost"}
PERIOD_S = 0.01


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return the plans from above, one a cost, above the distance of the CoP to the edge of the support."""
    figure = Figure(figsize=(TEXT_WIDTH, 3.2), layout="constrained")
    for column, (cost, name) in zip(figure.subplots(2, len(COSTS), sharey="row").T, COSTS.items(), strict=True):
        plan = results.plan(STUDY, cost)
        _draw_from_above(column[0], plan)
        column[0].set_title(name, loc="left")
        times, margins = support_margins(plan, PERIOD_S)
        column[1].plot(times, 1e3 * margins, ".", color=COP, markersize=1.5)
        column[1].set(xlabel="time [s]", ylim=(-10.0, None))
    figure.axes[0].set_ylabel("y [m]")
    figure.axes[len(COSTS)].set_ylabel("CoP to edge [mm]")
    figure.axes[0].legend(loc="upper left", ncols=2)
    return figure


def _draw_from_above(axes: Axes, plan: MotionPlan) -> None:
    placed = in_plan_frame(plan)
    for support in placed.supports:
        axes.add_patch(Polygon(support.corners, facecolor=GROUND, alpha=0.15, edgecolor="none"))
    axes.plot(*placed.com.T, color=MEASURED, label="CoM")
    axes.plot(*placed.cop.T, color=COP, linewidth=0.7, label="CoP")
    axes.set(xlabel="x [m]", aspect="equal")


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return the distance of the planned CoP to the edge of its support polygon over time, one block a cost."""
    blocks = []
    for cost in COSTS:
        plan = results.plan(STUDY, cost)
        times, margins = support_margins(plan, PERIOD_S)
        feet = [len(standing_feet(plan, float(time))) for time in times]
        blocks.append(pd.DataFrame({"cost": cost, "time_s": times, "feet": feet, "margin_mm": 1e3 * margins}))
    return pd.concat(blocks, ignore_index=True)


def claims(results: StudyResults) -> list[Claim]:
    """Return how often each cost's walk stays up and how far its CoP is from the edge."""
    table, samples = results.table(STUDY), numbers(results)
    swinging = samples[samples["feet"] == POLYGON_FEET]
    median = {cost: float(swinging.loc[swinging["cost"] == cost, "margin_mm"].median()) for cost in COSTS}
    robust, without = (table[table["cost"] == cost] for cost in ("robustness", "none"))
    found = [_survival(cost, name, table[table["cost"] == cost]) for cost, name in COSTS.items()]
    with_cost, without_cost = (wilson_interval(len(completed(rows)), len(rows)) for rows in (robust, without))
    better, clearly = with_cost.estimate > without_cost.estimate, with_cost.lower > without_cost.upper
    return [
        *found,
        Claim(
            "more walks stay up with the cost than without",
            "yes",
            f"{share(robust)} with, {share(without)} without",
            verdict(holds=clearly, partly=better),
            "" if clearly else "The intervals overlap: so few trials do not tell the costs apart.",
        ),
        Claim(
            "CoP to the edge of the support while a leg swings, median [mm]",
            "larger with the cost",
            ", ".join(f"{median[cost]:.0f} {name}" for cost, name in COSTS.items()),
            verdict(holds=median["robustness"] > max(median["acceleration"], median["none"])),
        ),
    ]


def _survival(cost: str, name: str, rows: pd.DataFrame) -> Claim:
    undiagnosed = "Why the others stay up where the real robot failed was not diagnosed. " if cost == "none" else ""
    paper = {"none": "fails", "robustness": "walks"}.get(cost, "-")
    text = f"stays up under all disturbances: {name}"
    return Claim(text, paper, share(rows), _verdict_of(cost, rows), undiagnosed + _falls(rows))


def _falls(rows: pd.DataFrame) -> str:
    """Return in which conditions trials did not complete, as a sentence; nothing if all did."""
    failed = rows.drop(completed(rows).index)[["controller", "disturbance"]].drop_duplicates()
    found = [
        f"{controller} without disturbance" if disturbance == "nothing" else f"{controller} under {disturbance}"
        for controller, disturbance in failed.itertuples(index=False)
    ]
    return f"Not completed: {', '.join(found)}." if found else ""


def _verdict_of(cost: str, rows: pd.DataFrame) -> Verdict:
    good = len(completed(rows))
    if cost == "none":
        return verdict(holds=good == 0, partly=good < len(rows))
    return verdict(holds=good == len(rows), partly=good > 0) if cost == "robustness" else Verdict.NEW
