"""Winkler 2017, V-A.1: eight steps over 0.5 m, in the rhythm of Table I, with and without the robustness cost."""

from collections.abc import Mapping

import numpy as np
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
from quadlab.plotting.axes.plan_view import COP_DOT
from quadlab.plotting.placed_plan import in_plan_frame
from quadlab.plotting.style import COP, GROUND, MEASURED, TEXT_WIDTH, paper_style

STUDY = "winkler2017_robustness"
CAPTION = (
    "Plans of a walk of HyQ, eight steps over 0.5 m in the rhythm of Table I, from above and distance of the CoP "
    "to the edge of the support over time, by cost. Without its cost, the CoM of the paper goes straight, as it "
    "does here with a cost of CoM accelerations, which the paper has not. Black: CoM; red: CoP every 10 ms; areas: "
    "support."
)
ARTEFACT = Artefact("W-X2", "Winkler 2017, V-A.1", "Walk with and without the robustness cost", (STUDY,), CAPTION)
COSTS = {"robustness": "robustness cost", "acceleration": "CoM acceleration instead", "none": "no cost"}
PAPER_CONTROLLER = "projected_inverse_dynamics"
CONTROLLERS = {
    PAPER_CONTROLLER: "controller of the paper",
    "hierarchical": "our controller",
}
STAYS_UP, SLIPPERY = "stays up under all disturbances", "low friction"
STRAIGHT_MM = 5.0
"""A CoM that keeps within a band so wide goes straight."""
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
    axes.plot(*placed.cop.T, **COP_DOT, label="CoP")
    axes.plot(*placed.com.T, color=MEASURED, label="CoM")
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
    """Return how each cost's walk stays up, how far it gets off its plan, and how far its CoP is from the edge."""
    table, samples = results.table(STUDY), numbers(results)
    swinging = samples[samples["feet"] == POLYGON_FEET]
    median = {cost: float(swinging.loc[swinging["cost"] == cost, "margin_mm"].median()) for cost in COSTS}
    groups = {cost: table[table["cost"] == cost] for cost in COSTS}
    found = [
        _with_cost(groups["robustness"]),
        _straight(groups["acceleration"], groups["robustness"]),
        _no_cost(groups["none"], median["none"]),
        _more_stay_up(groups["robustness"], groups["acceleration"]),
    ]
    return [
        *found,
        *(_com_error(table, controller, name) for controller, name in CONTROLLERS.items()),
        _sway(results),
        Claim(
            "CoP to the edge of the support while a leg swings, median [mm]",
            "larger with the cost",
            ", ".join(f"{median[cost]:.0f} {name}" for cost, name in COSTS.items()),
            verdict(holds=median["robustness"] > max(median["acceleration"], median["none"])),
        ),
    ]


def _with_cost(rows: pd.DataFrame) -> Claim:
    good = len(completed(rows))
    text = f"{STAYS_UP}: {COSTS['robustness']}"
    return Claim(text, "walks", _shares(rows), verdict(holds=good == len(rows), partly=good > 0), _falls(rows))


def _straight(rows: pd.DataFrame, robust: pd.DataFrame) -> Claim:
    """Return what became of the walk whose CoM goes straight, as that of the paper does without its cost."""
    good = len(completed(rows))
    text = f"{STAYS_UP}: {COSTS['acceleration']}, the straight CoM of the paper's walk without the cost"
    found = verdict(holds=good == 0, partly=good < len(completed(robust)))
    survives = "It leaves its plan, see the CoM errors, but recovers; why the real robot did not is not known. "
    return Claim(text, "fails", _shares(rows), found, (survives if good else "") + _falls(rows))


def _no_cost(rows: pd.DataFrame, margin_mm: float) -> Claim:
    text = f"{STAYS_UP}: {COSTS['none']}"
    centred = (
        f"An interior-point solver stays off the bounds: the CoP is {margin_mm:.0f} mm from the edge without a cost. "
    )
    return Claim(text, "-", _shares(rows), Verdict.NEW, centred + _falls(rows))


def _shares(rows: pd.DataFrame) -> str:
    """Return how many trials complete with both controllers, and with that of the paper alone."""
    paper = rows[rows["controller"] == PAPER_CONTROLLER]
    return f"{share(rows)}, {len(completed(paper))} of {len(paper)} with the {CONTROLLERS[PAPER_CONTROLLER]}"


def _more_stay_up(robust: pd.DataFrame, straight: pd.DataFrame) -> Claim:
    with_cost, without = (wilson_interval(len(completed(rows)), len(rows)) for rows in (robust, straight))
    clearly = with_cost.lower > without.upper
    return Claim(
        f"more walks stay up with the cost than with {COSTS['acceleration']}",
        "yes",
        f"{share(robust)} with, {share(straight)} without",
        verdict(holds=clearly, partly=with_cost.estimate > without.estimate),
        "" if clearly else "The intervals overlap: so few trials do not tell the costs apart.",
    )


def _com_error(table: pd.DataFrame, controller: str, name: str) -> Claim:
    """Return the median of the largest CoM errors by cost, falls included."""
    rows = table[(table["controller"] == controller) & (table["disturbance"] != SLIPPERY)]
    medians = rows.groupby("cost")["com_error_max_mm"].median()
    ours = ", ".join(f"{medians[cost]:.1f} {label}" for cost, label in COSTS.items())
    count = len(rows) // len(COSTS)
    text = f"largest CoM error, {name}, {SLIPPERY} left out: median of {count} trials, falls included [mm]"
    return Claim(text, "not printed", ours, Verdict.NEW)


def _sway(results: StudyResults) -> Claim:
    """Return how widely the planned CoM sways."""
    return sway_claim({cost: 1e3 * float(np.ptp(in_plan_frame(results.plan(STUDY, cost)).com[:, 1])) for cost in COSTS})


def sway_claim(widths_mm: Mapping[str, float]) -> Claim:
    """Return the claim on how wide a band, in [mm], the planned CoM needs by cost; one it has not may straighten it."""
    ours = ", ".join(f"{widths_mm[cost]:.0f} {name}" for cost, name in COSTS.items())
    less = widths_mm["robustness"] > widths_mm["none"]
    straight = widths_mm["none"] <= STRAIGHT_MM
    why = (
        "" if straight else "Without any cost the CoM is not straight; the cost that straightens it is not the paper's."
    )
    text = "the planned CoM sways with the cost and is straight without: width of the sway [mm]"
    found = verdict(holds=less and straight, partly=less)
    return Claim(text, "sways, straight line without", ours, found, why)


def _falls(rows: pd.DataFrame) -> str:
    """Return in which conditions trials did not complete, as a sentence; nothing if all did."""
    failed = rows.drop(completed(rows).index)[["controller", "disturbance"]].drop_duplicates()
    found = [
        f"{CONTROLLERS[controller]} {'without disturbance' if disturbance == 'nothing' else f'under {disturbance}'}"
        for controller, disturbance in failed.itertuples(index=False)
    ]
    return f"Not completed: {', '.join(found)}." if found else ""
