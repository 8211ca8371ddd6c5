"""Gehring 2017, Fig. 4: the objective over the iterations of the SQP, three motions."""

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from paper_figures.study_origin import processor
from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.plotting.style import COLUMN_WIDTH, SERIES, paper_style

STUDY = "gehring2017_table1"
CAPTION = (
    "Sum of all objectives of the first guess (iteration 0) and after each step of the SQP, logarithmic; walk, "
    "trot and transition of Table I, from standing, without stances before and after."
)
ARTEFACT = Artefact("G-F4", "Gehring 2017, Fig. 4", "Objective over the iterations of the SQP", (STUDY,), CAPTION)
PAPER_PROCESSOR = "Intel Core i5-5300U, 2.3 GHz, two cores"
PAPER_ITERATIONS, PAPER_SECONDS = 6, (6.0, 8.0)
CONVERGED = 0.01
"""A cost that is less than this share above its last value counts as converged."""


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return the objective of the guess and after each iteration, one line a motion."""
    table = numbers(results)
    figure = Figure(figsize=(COLUMN_WIDTH, 2.0), layout="constrained")
    axes = figure.subplots()
    for (motion, rows), colour in zip(table.groupby("motion", sort=False), SERIES[1:], strict=True):
        axes.semilogy(rows["iteration"], rows["total"], "o-", markersize=2.5, color=colour, label=str(motion))
    axes.set(xlabel="iteration", ylabel="objective")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.legend(loc="upper right", ncols=3)
    return figure


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return the objective by motion and iteration; iteration 0 is the guess."""
    rows = [
        {"motion": row["motion"], "iteration": iteration, "total": row[f"total_{iteration}"]}
        for _, row in results.table(STUDY).iterrows()
        for iteration in range(int(row["iterations"]) + 1)
    ]
    return pd.DataFrame(rows)


def claims(results: StudyResults) -> list[Claim]:
    """Return after how many iterations the objective has converged, and how long that takes."""
    table = results.table(STUDY)
    needed = {
        str(motion): int(rows.loc[rows["total"] <= (1.0 + CONVERGED) * rows["total"].iloc[-1], "iteration"].min())
        for motion, rows in numbers(results).groupby("motion", sort=False)
    }
    ours = ", ".join(f"{motion} {count}" for motion, count in needed.items())
    slowest_s = 1e-3 * float((table["build_ms"] + table["solve_ms"]).max())
    within = max(needed.values()) <= PAPER_ITERATIONS
    return [
        Claim(
            f"iterations until the objective is within {100 * CONVERGED:g} % of its last value",
            str(PAPER_ITERATIONS),
            ours,
            verdict(holds=within, partly=min(needed.values()) <= PAPER_ITERATIONS),
            "" if within else "The paper stops after six; distances and regulariser that it does not print matter.",
        ),
        Claim(
            "planning time [s]",
            f"{PAPER_SECONDS[0]:g} to {PAPER_SECONDS[1]:g}, {PAPER_PROCESSOR}",
            f"{slowest_s:.2g} at most, building included, {processor(STUDY, results)}",
            verdict(holds=slowest_s <= PAPER_SECONDS[1]),
        ),
    ]
