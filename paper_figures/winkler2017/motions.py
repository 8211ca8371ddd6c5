"""Winkler 2017, V-A.3 and video: limping, transitions, pace, bound and push recovery of HyQ, as a table."""

import pandas as pd
from matplotlib.figure import Figure

from paper_figures.trial_claims import completed, share
from quadlab.analysis.artefact import Artefact, Claim, Verdict, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import paper_style
from quadlab.plotting.table_figure import TableText, table_figure

STUDY = "winkler2017_motions"
ARTEFACT = Artefact("W-X3", "Winkler 2017, video", "Limp, transitions, pace, bound and pushes", (STUDY,))
FOLLOWED_MM = 100.0
"""Farther off the plan than that, a robot that stays up has stumbled."""
STUMBLES = "It stumbles out of the plan and stays up; why was not diagnosed."
TRACKED = ("hierarchical", "projected_inverse_dynamics")


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return the table: shares of trials that stay up and the CoM error of those, by motion and controller."""
    rows = [
        (
            str(row["motion"]),
            str(row["controller"]),
            f"{row['completed']} of {row['trials']}",
            "-" if pd.isna(row["com_error_max_mm"]) else f"{row['com_error_max_mm']:.0f}",
        )
        for _, row in numbers(results).iterrows()
    ]
    header = (("motion", "controller", "stay up", "CoM error, max [mm]"),)
    return table_figure(TableText(header, tuple(rows), left=2))


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return one row a motion and controller: trials, completed ones and their largest CoM error in [mm]."""
    rows = []
    for (motion, controller), trials in results.table(STUDY).groupby(["motion", "controller"], sort=False):
        good = completed(trials)
        largest = good["com_error_max_mm"].max() if len(good) else float("nan")
        rows.append((motion, controller, len(trials), len(good), largest))
    return pd.DataFrame(rows, columns=["motion", "controller", "trials", "completed", "com_error_max_mm"])


def claims(results: StudyResults) -> list[Claim]:
    """Return which motions stay up with the hierarchical controller, and what the paper's does."""
    table = results.table(STUDY)
    found = [
        _motion(str(motion), rows)
        for motion, rows in table[table["controller"] == TRACKED[0]].groupby("motion", sort=False)
    ]
    printed = table[table["controller"] == TRACKED[1]]
    text = "motions that stay up with projected inverse dynamics"
    return [*found, Claim(text, "shown in the video", share(printed), Verdict.NEW)]


def _motion(motion: str, rows: pd.DataFrame) -> Claim:
    good = completed(rows)
    follows = good[good["com_error_max_mm"] <= FOLLOWED_MM]
    ours = f"{share(rows)}; {len(follows)} never more than {FOLLOWED_MM:g} mm off the plan"
    holds = len(follows) == len(rows)
    text = f"{motion} stays up, hierarchical, ekf and truth"
    return Claim(
        text, "shown in the video", ours, verdict(holds=holds, partly=len(good) > 0), "" if holds else STUMBLES
    )
