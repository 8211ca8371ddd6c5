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
    "the trials that stay up. Limp: LF touches the ground only while its neighbours swing; three legs: LF is never "
    "put down. Pushes: 200 and 400 N for 0.15 s while trotting forward, to the front and to the left; replanned: a new "
    "plan every 20 ms. The paper shows these motions as plans; its robot walks and trots only."
)
ARTEFACT = Artefact("W-X3", "Winkler 2017, video", "Limp, transitions, pace, bound and pushes", (STUDY, PLANS), CAPTION)
SHOWN = "planned motion shown"
FOLLOWED_MM = 100.0
"""Farther off the plan than that, a robot that stays up has stumbled."""
TRACKED = {"hierarchical": "ours", "projected_inverse_dynamics": "of the paper"}


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return the table, by motion and controller: starts, trials that stay up and that follow, CoM error."""
    rows = [
        (
            str(row["motion"]),
            TRACKED[str(row["controller"])],
            str(row["starts"]),
            f"{row['completed']} of {row['trials']}",
            f"{row['followed']} of {row['trials']}",
            "-" if pd.isna(row["com_error_max_mm"]) else f"{row['com_error_max_mm']:.0f}",
        )
        for _, row in numbers(results).iterrows()
    ]
    biped = ("biped", "planned only, see W-F3", "-", "-", "-", "-")
    follow = f"and never > {FOLLOWED_MM:g} mm off"
    header = (("motion", "controller", "starts", "stay up", follow, "CoM error, max [mm]"),)
    return table_figure(TableText(header, (*rows, biped), left=2))


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return one row a motion and controller: starts, trials, completed, followed, largest CoM error in [mm]."""
    rows = []
    for (motion, controller), trials in results.table(STUDY).groupby(["motion", "controller"], sort=False):
        good = completed(trials)
        largest = good["com_error_max_mm"].max() if len(good) else float("nan")
        counts = (trials["seed"].nunique(), len(trials), len(good), _followed(good))
        rows.append((motion, controller, *counts, largest))
    columns = ["motion", "controller", "starts", "trials", "completed", "followed", "com_error_max_mm"]
    return pd.DataFrame(rows, columns=columns)


def _followed(completed_rows: pd.DataFrame) -> int:
    """Return how many trials that stay up never stumble."""
    return int((completed_rows["com_error_max_mm"] <= FOLLOWED_MM).sum())


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
    starts = rows["seed"].nunique()
    origin = f"{starts} start{'s' if starts > 1 else ''}"
    ours = f"{share(rows)} from {origin}; {_followed(completed(rows))} never more than {FOLLOWED_MM:g} mm off"
    failures = rows.drop(completed(rows).index)["status"].str.replace("_", " ").value_counts()
    reasons = ", ".join(f"{count} {status}" for status, count in failures.items())
    why = f"Not completed: {reasons}." if reasons else ""
    return Claim(f"{motion} in closed loop, controller {controller}: stays up", SHOWN, ours, Verdict.NEW, why)
