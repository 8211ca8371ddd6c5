"""Winkler 2017, V-A.3 and video: limping, transitions, pace, bound and push recovery of HyQ, as a table.

The paper shows these as planned motions; its robot walks and trots only.
"""

import pandas as pd
from matplotlib.figure import Figure

from paper_figures.trial_claims import completed, share
from quadlab.analysis.artefact import Artefact, Claim, Verdict, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import paper_style
from quadlab.plotting.table_figure import TableText, table_figure

STUDY, PLANS = "winkler2017_motions", "winkler2017_table1"
CAPTION = (
    "HyQ in closed loop, nominal and perturbed starts, estimators ekf and truth together; CoM error: largest of "
    "the trials that stay up. The paper shows these motions as plans; its robot walks and trots only."
)
ARTEFACT = Artefact("W-X3", "Winkler 2017, video", "Limp, transitions, pace, bound and pushes", (STUDY, PLANS), CAPTION)
SHOWN = "planned motion shown"
FOLLOWED_MM = 100.0
"""Farther off the plan than that, a robot that stays up has stumbled."""
TRACKED = {"hierarchical": "our controller", "projected_inverse_dynamics": "the controller of the paper"}


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return the table: starts, shares of trials that stay up and their CoM error, by motion and controller."""
    rows = [
        (
            str(row["motion"]),
            str(row["controller"]),
            str(row["starts"]),
            f"{row['completed']} of {row['trials']}",
            "-" if pd.isna(row["com_error_max_mm"]) else f"{row['com_error_max_mm']:.0f}",
        )
        for _, row in numbers(results).iterrows()
    ]
    biped = ("biped", "planned only, see Fig. 3", "-", "-", "-")
    header = (("motion", "controller", "starts", "stay up", "CoM error, max [mm]"),)
    return table_figure(TableText(header, (*rows, biped), left=2))


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return one row a motion and controller: starts, trials, completed ones and their largest CoM error in [mm]."""
    rows = []
    for (motion, controller), trials in results.table(STUDY).groupby(["motion", "controller"], sort=False):
        good = completed(trials)
        largest = good["com_error_max_mm"].max() if len(good) else float("nan")
        rows.append((motion, controller, trials["seed"].nunique(), len(trials), len(good), largest))
    return pd.DataFrame(rows, columns=["motion", "controller", "starts", "trials", "completed", "com_error_max_mm"])


def claims(results: StudyResults) -> list[Claim]:
    """Return that all motions are planned, and which of them stay up in closed loop, which the paper does not show."""
    table = results.table(STUDY)
    closed_loop = [
        _closed_loop(str(motion), name, rows[rows["controller"] == controller])
        for controller, name in TRACKED.items()
        for motion, rows in table.groupby("motion", sort=False)
        if controller in set(rows["controller"])
    ]
    return [_planned(table), _biped(results), *closed_loop]


def _planned(table: pd.DataFrame) -> Claim:
    refused = int((table["status"] == "planning_failed").sum())
    ours = f"{len(table) - refused} of {len(table)} trials have a plan that passes the checker"
    text = f"motions that are planned: {', '.join(table['motion'].unique())}"
    return Claim(text, SHOWN, ours, verdict(holds=refused == 0, partly=refused < len(table)))


def _biped(results: StudyResults) -> Claim:
    found = results.plan(PLANS, "biped").verdict
    ours = f"planned only, see W-F3; {', '.join(found.violated) or 'passes the checker'}"
    return Claim("biped walk", SHOWN, ours, verdict(holds=found.accepted))


def _closed_loop(motion: str, controller: str, rows: pd.DataFrame) -> Claim:
    follows = completed(rows)["com_error_max_mm"] <= FOLLOWED_MM
    starts = rows["seed"].nunique()
    origin = f"{starts} start{'s' if starts > 1 else ''}"
    ours = f"{share(rows)} from {origin}; {int(follows.sum())} never more than {FOLLOWED_MM:g} mm off"
    failures = rows.drop(completed(rows).index)["status"].str.replace("_", " ").value_counts()
    reasons = ", ".join(f"{count} {status}" for status, count in failures.items())
    why = f"Not completed: {reasons}." if reasons else ""
    return Claim(f"{motion} in closed loop with {controller}: stays up", SHOWN, ours, Verdict.NEW, why)
