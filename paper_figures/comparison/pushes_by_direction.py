"""The largest push survived by direction, for each planner and controller."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MultipleLocator

from paper_figures.comparison_variants import COLOURS, CONTROLLERS, PLANNERS, STUDY, artefact, short
from paper_figures.known_limits import known_limits, limit_text
from paper_figures.push_limits import speeds_mps
from quadlab.analysis.artefact import Claim, Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import TEXT_WIDTH, paper_style

CAPTION = (
    "Largest push of 0.15 s that ANYmal B survives by its direction, straight ahead is up; the radius is J/m in "
    "m/s, the median over two phases of the stride, on a grid of 0.1 m/s. One row a gait, one column a controller, one "
    "colour a planner; zmp_spline plans walks alone. Estimator ekf."
)
ARTEFACT = artefact("directions", "Largest push survived by direction", CAPTION)
CIRCLES_MPS = 0.5
"""Distance of circles in [m/s]."""
LABELS_DEG = 22.5
"""Where the circles are labelled: between two directions, of which no marker is near."""
GAITS = ("trot", "walk")


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return polar plots, one a gait and controller: straight ahead is up, the radius is the change of velocity."""
    limits = numbers(results)
    figure = Figure(figsize=(TEXT_WIDTH, 5.3), layout="constrained")
    reach_mps = 1.04 * limits["median_mps"].max()
    panels = [(gait, controller) for gait in GAITS for controller in CONTROLLERS]
    for place, (gait, controller) in enumerate(panels, 1):
        axes = figure.add_subplot(len(GAITS), len(CONTROLLERS), place, projection="polar")
        assert isinstance(axes, PolarAxes)
        _draw_planners(axes, limits[(limits["gait"] == gait) & (limits["controller"] == controller)])
        axes.set_ylim(0.0, reach_mps)
        axes.set_title(f"{gait}, {short(controller)}", pad=9)
    handles, labels = figure.axes[-1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(PLANNERS), handlelength=3.0)
    return figure


def _draw_planners(axes: PolarAxes, limits: pd.DataFrame) -> None:
    axes.set_theta_zero_location("N")
    axes.set_thetagrids([0, 90, 180, 270], ["forward", "left", "back", "right"])
    for planner in PLANNERS:
        rows = limits[limits["planner"] == planner]
        if rows.empty:
            continue
        closed = pd.concat([rows, rows.head(1)])
        axes.plot(
            np.radians(closed["direction_deg"]),
            closed["median_mps"],
            "o-",
            color=COLOURS[planner],
            markersize=2.5,
            label=planner,
        )
    axes.yaxis.set_major_locator(MultipleLocator(CIRCLES_MPS))
    axes.set_rlabel_position(LABELS_DEG)
    axes.tick_params(axis="y", labelsize=6.0)


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return the median over the phases of the stride, one row a gait, planner, controller and direction."""
    groups = _speeds(results).groupby(["gait", "planner", "controller", "direction_deg"])["mps"]
    return groups.agg(median_mps="median", minimum_mps="min", cases="count").reset_index()


def _speeds(results: StudyResults) -> pd.DataFrame:
    """Return one row a direction and phase of all pushes, with J / m in [m/s]."""
    limits = known_limits(results, STUDY)
    pushes = limits[limits["disturbance"] == "push"]
    return pushes.assign(direction_deg=pushes["direction"].astype(float), mps=speeds_mps(pushes))


def claims(results: StudyResults) -> list[Claim]:
    """Return the smallest and median limit of each combination, of all directions and phases alike."""
    found = _speeds(results)
    return [
        Claim(
            f"{gait}, {planner}, {controller}: push survived, minimum / median over directions and phases [m/s]",
            "-",
            f"{limit_text(rows['mps'].min(), 2)} / {limit_text(rows['mps'].median(), 2)} ({len(rows)} cases)",
            Verdict.NEW,
        )
        for (gait, planner, controller), rows in found.groupby(["gait", "planner", "controller"])
    ]
