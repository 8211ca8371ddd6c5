"""What claims about closed-loop trials have in common: shares, largest values, how variants did."""

import pandas as pd

from quadlab.analysis.artefact import Claim, Verdict, verdict
from quadlab.studies.report import success_share

COMPLETED = "completed"
SILENT = ("-", "not printed", "not measured")
"""What stands in place of the paper's value where it has none."""
VARIANTS = {
    "alignment none": "without alignment of the plan",
    "alignment base": "with base-centred alignment alone",
    "alignment feet": "with feet-centred alignment alone",
    "no foothold feedback": "without foothold feedback",
    "capture point ignored": "with lift-offs and swings as planned, wherever the capture point is",
    "stack of the paper": "with the priorities of the paper",
}
"""Levels of the factor ``variant`` beside "reference": one part of the controller changed."""


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
    """Return the claim that ``needed`` of ``rows``, all if not given, stay up; ``why`` is said where they do not."""
    good = len(completed(rows))
    holds = good >= (len(rows) if needed is None else needed)
    return Claim(text, paper, share(rows), judged(paper, holds=holds, partly=good > 0), "" if holds else why)


def at_most(text: str, rows: pd.DataFrame, column: str, limit: float, unit: str, *, paper: str, why: str = "") -> Claim:
    """Return the claim that ``column`` stays below ``limit`` in every completed trial of ``rows``."""
    values = completed(rows)[column]
    worst, median = float(values.max()), float(values.median())
    holds = worst <= limit
    ours = f"{median:.3g} {unit} median, {worst:.3g} {unit} worst of {len(values)}"
    return Claim(text, paper, ours, judged(paper, holds=holds, partly=median <= limit), "" if holds else why)


def variant_claims(rows: pd.DataFrame, column: str, names: dict[str, str], what: str = "stays up") -> list[Claim]:
    """Return one claim a variant that was tried, a level of ``column``: what became of it; no paper says it."""
    tried = set(rows[column])
    return [
        Claim(f"{what} {text}", "not printed", share(rows[rows[column] == level]), Verdict.NEW)
        for level, text in names.items()
        if level in tried
    ]
