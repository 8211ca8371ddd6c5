"""Winkler 2017, Fig. 2: the trot problem over time."""

import pandas as pd
from matplotlib.figure import Figure

from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.plan_figure import plan_figure
from quadlab.robots.legs import LEGS

STUDY = "winkler2017_table1"
ARTEFACT = Artefact("W-F2", "Winkler 2017, Fig. 2", "The trot problem over time", (STUDY,))
PERIOD_S = 0.02


def draw(results: StudyResults) -> Figure:
    """Return the plan from above, its coordinates over time and its contact schedule."""
    return plan_figure(results.plan(STUDY, "trot_4"))


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return CoM, CoP and which legs stand, over time."""
    plan = results.plan(STUDY, "trot_4")
    rows = []
    for step in range(round(plan.duration_s / PERIOD_S) + 1):
        sample = plan.at(step * PERIOD_S)
        stands = [int(flag) for flag in sample.contacts]
        rows.append((step * PERIOD_S, *sample.com_position[:2], *sample.cop, *stands))
    return pd.DataFrame(rows, columns=["time_s", "com_x_m", "com_y_m", "cop_x_m", "cop_y_m", *LEGS])


def claims(results: StudyResults) -> list[Claim]:
    """Return that the plan satisfies what the figure of the paper explains."""
    found = results.plan(STUDY, "trot_4").verdict
    text = "dynamics, range of motion, CoP and goal hold between the nodes as well"
    return [Claim(text, "yes", ", ".join(found.violated) or "yes", verdict(holds=found.accepted))]
