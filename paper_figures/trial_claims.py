"""What claims about closed-loop trials have in common: shares, largest values, how variants did."""

import pandas as pd

from quadlab.analysis.artefact import Claim, Verdict, verdict
from quadlab.studies.report import success_share

COMPLETED = "completed"
LEG_LENGTH_M = 0.564
"""Thigh and shank of ANYmal B."""
STACKS = {"hierarchical": "our priorities", "gehring2017": "the priorities of the paper"}
"""The controllers that the trials of Gehring 2017 are run with."""
PAPER_STACK = "stack of the paper"
"""Level of the factor ``variant`` whose controller has the priorities that the paper prints."""
SWING_FIRST = "swing above base"
"""The same with the legs in the air above the base."""
PAPER_STACK_WHY = (
    "The base stands above the legs in the air. On two feet it is turned about the line between them only by bending "
    "these legs, which the drives hold: its forces are planned for a motion that does not come. The swing legs above "
    "the base, in a row below, show what that costs. Gains of the drives and sizes of disturbances are not printed."
)
FEWEST_TRIALS = 5
"""From that many trials on a success of the paper counts as reproduced."""
TOO_FEW = f"Fewer than {FEWEST_TRIALS} trials say little."
SILENT = ("-", "not printed", "not measured")
"""What stands in place of the paper's value where it has none."""
VARIANTS = {
    "alignment none": "without alignment of the plan",
    "alignment base": "with base-centred alignment alone",
    "alignment feet": "with feet-centred alignment alone",
    "no foothold feedback": "without foothold feedback",
    "capture point ignored": "with lift-offs and swings as planned, wherever the capture point is",
    PAPER_STACK: "with the priorities of the paper",
    SWING_FIRST: "with the priorities of the paper, swing legs above the base",
}
"""Levels of the factor ``variant`` beside "reference": one part of the controller changed, or all priorities."""


def judged(paper: str, *, holds: bool, partly: bool = False) -> Verdict:
    """Return the verdict, which is "new" where the paper says nothing that could be reproduced."""
    return Verdict.NEW if paper in SILENT else verdict(holds=holds, partly=partly)


def completed(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the trials that stayed up to their end."""
    return rows[rows["status"] == COMPLETED]


def share(rows: pd.DataFrame) -> str:
    """Return how many of ``rows`` completed, with Wilson's interval."""
    return success_share(len(completed(rows)), len(rows))


def survival(text: str, rows: pd.DataFrame, paper: str, needed: int | None = None, why: str = "") -> Claim:
    """Return the claim that ``needed`` of ``rows``, all if not given, stay up; ``why`` is said where they do not.

    Fewer than ``FEWEST_TRIALS`` reproduce nothing.
    """
    good = len(completed(rows))
    holds, enough = good >= (len(rows) if needed is None else needed), len(rows) >= FEWEST_TRIALS
    found = judged(paper, holds=holds and enough, partly=good > 0)
    few = "" if enough or found is Verdict.NEW else TOO_FEW
    return Claim(text, paper, share(rows), found, " ".join(filter(None, ["" if good == len(rows) else why, few])))


def paper_stack(rows: pd.DataFrame, paper: str, what: str = "stays up") -> Claim:
    """Return what became of those of ``rows`` with the priorities of the paper, beside what it reports."""
    chosen = rows[rows["variant"] == PAPER_STACK]
    return survival(f"{what} {VARIANTS[PAPER_STACK]}", chosen, paper, why=PAPER_STACK_WHY)


def at_most(text: str, rows: pd.DataFrame, column: str, limit: float, unit: str, *, paper: str, why: str = "") -> Claim:
    """Return the claim that ``column`` stays below ``limit`` in every completed trial of ``rows``."""
    values = completed(rows)[column]
    worst, median = float(values.max()), float(values.median())
    holds = worst <= limit
    ours = f"{median:.3g} {unit} median, {worst:.3g} {unit} worst of {len(values)}"
    return Claim(text, paper, ours, judged(paper, holds=holds, partly=median <= limit), "" if holds else why)


def variant_claims(rows: pd.DataFrame, what: str = "stays up") -> list[Claim]:
    """Return one claim a variant of our controller that was tried: what became of it; no paper says it."""
    tried = set(rows["variant"]) - {PAPER_STACK}
    return [
        Claim(f"{what} {text}", "not printed", share(rows[rows["variant"] == level]), Verdict.NEW)
        for level, text in VARIANTS.items()
        if level in tried
    ]
