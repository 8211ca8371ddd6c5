"""Winkler 2017, Fig. 3: a biped with rectangular feet, its support areas, range of motion and CoP."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from scipy.spatial import ConvexHull

from paper_figures.winkler2017.figure2_trot_overview import ENFORCED
from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.geometry.rotations import Array, rotation_2d
from quadlab.planners.plan import MotionPlan
from quadlab.planners.sampling import turned_vertices
from quadlab.planners.vertex_zmp.biped import RECTANGULAR_FOOT, biped_model
from quadlab.plotting.style import COLUMN_WIDTH, COP, LEG_COLOURS, MEASURED, NEUTRAL, SERIES, paper_style

STUDY = "winkler2017_table1"
CAPTION = (
    "Plan of a biped with rectangular feet from above. Coloured outlines: feet in their stances; green areas: support "
    "while both feet stand; grey: range of motion of both feet at 0.7 s, when the CoM is at the black dot; red: CoP. "
    "Nothing is simulated."
)
ARTEFACT = Artefact("W-F3", "Winkler 2017, Fig. 3", "A biped with feet that have an area", (STUDY,), CAPTION)
FEET = ("left", "right")
INSIDE_MM = 0.1
SHOWN_S = 0.7
"""Time in [s], in the second double support, whose range of motion is drawn; a dot is the CoM then."""


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return feet, the hulls of both feet in double support, CoM and CoP from above."""
    plan = results.plan(STUDY, "biped")
    figure = Figure(figsize=(COLUMN_WIDTH, 2.8), layout="constrained")
    axes = figure.subplots()
    for number, corners in enumerate(double_supports(plan)):
        hull, label = corners[ConvexHull(corners).vertices], "" if number else "support on both feet"
        axes.add_patch(Polygon(hull, facecolor=SERIES[3], alpha=0.2, edgecolor="none", label=label))
    for foot in range(len(FEET)):
        box, label = reach_box(plan, foot, SHOWN_S), "" if foot else f"range of motion at {SHOWN_S:g} s"
        axes.add_patch(Polygon(box, facecolor=(NEUTRAL, 0.12), edgecolor=NEUTRAL, linewidth=0.7, label=label))
    for foot, (name, colour) in enumerate(zip(FEET, LEG_COLOURS, strict=False)):
        for number, corners in enumerate(foot_corners(plan, foot)):
            label = name if number == 0 else ""
            axes.add_patch(Polygon(corners, fill=False, edgecolor=colour, linewidth=1.0, label=label))
    times = np.arange(0.0, plan.duration_s, 0.01)
    axes.plot(*np.array([plan.com(time)[:2] for time in times]).T, color=MEASURED, label="CoM")
    axes.plot(*np.array([plan.cop(time) for time in times]).T, ".", color=COP, markersize=2.0, label="CoP")
    axes.plot(*plan.com(SHOWN_S)[:2], "o", color=MEASURED, markersize=4.0, label=f"CoM at {SHOWN_S:g} s")
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    figure.legend(loc="outside upper center", ncols=3)
    return figure


def reach_box(plan: MotionPlan, foot: int, time_s: float) -> Array:
    """Return the corners of the box in which a foot may be at ``time_s`` in [s], (4, 2) in [m]."""
    model, sample = biped_model(RECTANGULAR_FOOT), plan.at(time_s)
    corners = model.nominal_feet[foot] + model.reach * np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]])
    return np.asarray(sample.com_position[:2] + corners @ rotation_2d(sample.yaw).T)


def foot_corners(plan: MotionPlan, foot: int) -> list[Array]:
    """Return the corners of a foot in each of its stances, (4, 2) in [m]."""
    pairs = zip(plan.footholds[foot], plan.foot_yaws[foot], strict=True)
    return [place[:2] + turned_vertices(RECTANGULAR_FOOT, yaw) for place, yaw in pairs]


def double_supports(plan: MotionPlan) -> list[Array]:
    """Return the corners of both feet in every phase in which both stand, (8, 2) in [m]."""
    stances = [0, 0]
    phases = [np.concatenate([foot_corners(plan, foot)[stances[foot]] for foot in range(2)])]
    swings = sorted((swing.end_s, foot) for foot in range(2) for swing in plan.schedule.swings[foot])
    for _, foot in swings:
        stances[foot] += 1
        phases.append(np.concatenate([foot_corners(plan, each)[stances[each]] for each in range(2)]))
    return phases


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return position and yaw of each foot in each stance."""
    plan = results.plan(STUDY, "biped")
    rows = [
        (name, number, float(place[0]), float(place[1]), float(np.degrees(yaw)))
        for foot, name in enumerate(FEET)
        for number, (place, yaw) in enumerate(zip(plan.footholds[foot], plan.foot_yaws[foot], strict=True))
    ]
    return pd.DataFrame(rows, columns=["foot", "stance", "x_m", "y_m", "yaw_deg"])


def claims(results: StudyResults) -> list[Claim]:
    """Return that the CoP stays in the rotated feet."""
    found = results.plan(STUDY, "biped").verdict
    outside = found.values["cop_outside_mm"]  # noqa: PD011 - no table
    text = "CoP inside the area of the standing feet: farthest outside [mm]"
    return [Claim(text, "inside", f"{outside:.1g}", verdict(holds=outside < INSIDE_MM), ENFORCED)]
