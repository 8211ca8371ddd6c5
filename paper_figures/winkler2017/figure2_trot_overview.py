"""Winkler 2017, Fig. 2: the trot problem over time: CoM, CoP, support and range of motion in the walking direction."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan
from quadlab.planners.vertex_zmp.table_one import HYQ
from quadlab.plotting.axes.contact_bands import draw_contact_bands, planned_bands
from quadlab.plotting.axes.time_rows import BANDS_HEIGHT, share_time
from quadlab.plotting.placed_plan import stance_spans
from quadlab.plotting.style import COP, LEG_COLOURS, MEASURED, NEUTRAL, SERIES, TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEGS

STUDY = "winkler2017_table1"
CAPTION = (
    "Plan of the trot of Table I, 16 steps over 1 m, x over time. Grey areas: range of motion of the fore and "
    "hind feet; green: support; coloured bars: feet where they stand; below: which leg stands when. Nothing is "
    "simulated."
)
ARTEFACT = Artefact("W-F2", "Winkler 2017, Fig. 2", "The trot problem over time", (STUDY,), CAPTION)
PERIOD_S = 0.02
ENFORCED = "Enforced by the planner, confirmed by the checker."
FORE, HIND = 0, 2
"""Legs whose range of motion is drawn: in the direction of travel the one beside has the same."""
HEIGHT = 2.3  # [in] of the coordinates over time


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return x over time of CoM, CoP, feet, support and range of motion, above the contact schedule."""
    plan = results.plan(STUDY, "trot")
    figure = Figure((TEXT_WIDTH, HEIGHT + BANDS_HEIGHT + 0.7), layout="constrained")
    axes, bands = figure.subplots(2, height_ratios=(HEIGHT, BANDS_HEIGHT))
    times = np.arange(0.0, plan.duration_s + 0.5 * PERIOD_S, PERIOD_S)
    _draw_areas(axes, plan, times)
    for leg, colour in enumerate(LEG_COLOURS):
        places = plan.footholds[leg][:, 0]
        for place, span in zip(places, stance_spans(plan, leg, plan.duration_s), strict=True):
            axes.plot(span, [place, place], color=colour, linewidth=2.0, solid_capstyle="butt")
    axes.plot(times, [plan.com(time)[0] for time in times], color=MEASURED, linewidth=1.4, label="CoM")
    axes.plot(times, [plan.cop(time)[0] for time in times], ".", color=COP, markersize=3.0, label="CoP")
    axes.set_ylabel("x [m]")
    draw_contact_bands(bands, planned_bands(plan.schedule))
    share_time([axes], bands, plan.duration_s)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper center", ncols=4)
    figure.align_ylabels()
    return figure


def _draw_areas(axes: Axes, plan: MotionPlan, times: Array) -> None:
    """Draw between which x the feet may be, fore and hind, and the CoP."""
    com = np.array([plan.com(time)[0] for time in times])
    for leg in (FORE, HIND):
        centre, label = com + HYQ.nominal_feet[leg, 0], "range of motion, fore and hind" if leg == FORE else ""
        axes.fill_between(
            times, centre - HYQ.reach[0], centre + HYQ.reach[0], color=NEUTRAL, alpha=0.2, lw=0, label=label
        )
    switches = plan.schedule.switch_times_s
    for phase, contacts in enumerate(plan.schedule.contacts):
        middle = 0.5 * float(switches[phase] + switches[phase + 1])
        feet = [plan.foothold_at(int(leg), middle)[0] for leg in np.flatnonzero(contacts)]
        label = "support" if phase == 0 else ""
        axes.fill_between(
            switches[phase : phase + 2], min(feet), max(feet), color=SERIES[3], alpha=0.15, lw=0, label=label
        )


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return CoM, CoP and which legs stand, over time."""
    plan = results.plan(STUDY, "trot")
    rows = []
    for step in range(round(plan.duration_s / PERIOD_S) + 1):
        sample = plan.at(step * PERIOD_S)
        stands = [int(flag) for flag in sample.contacts]
        rows.append((step * PERIOD_S, *sample.com_position[:2], *sample.cop, *stands))
    return pd.DataFrame(rows, columns=["time_s", "com_x_m", "com_y_m", "cop_x_m", "cop_y_m", *LEGS])


def claims(results: StudyResults) -> list[Claim]:
    """Return that the plan satisfies what the figure of the paper explains."""
    found = results.plan(STUDY, "trot").verdict
    text = "dynamics, range of motion, CoP and goal hold between the nodes as well"
    return [Claim(text, "yes", ", ".join(found.violated) or "yes", verdict(holds=found.accepted), ENFORCED)]
