"""The largest push survived, by direction and phase: claims that several artefacts share."""

import pandas as pd

from paper_figures.known_limits import limit_text
from paper_figures.trial_claims import VARIANTS, completed, survival
from quadlab.analysis.artefact import Claim, Verdict

PUSH_S = 0.15
"""Duration of every push in [s]."""
ANYMAL_KG = 30.475
"""Mass of ANYmal B in [kg]."""
SIZE = "at 0.6 m/s"
"""The variant in which all cases are pushed equally."""
CASE = ["direction", "scenario.pushes.0.start_s"]
"""Columns that tell apart the pushes of a variant."""


def speeds_mps(limits: pd.DataFrame) -> "pd.Series[float]":
    """Return the change of velocity J / m of the largest force survived, 0 where even the smallest tried fells it."""
    return limits["limit"].fillna(0.0) * PUSH_S / ANYMAL_KG


def limit_claims(limits: pd.DataFrame, table: pd.DataFrame, needed_mps: tuple[float, float], what: str) -> list[Claim]:
    """Return smallest and median push survived, of the reference and of the variants beside it at the same cases.

    A search finds a push that is survived below one that is not and tries no others: all cases at one size show
    whether smaller ones may fell the robot too, and where they do the first claim says so.

    Args:
        limits: one row a direction and phase, by ``variant``.
        table: all trials, among them those of the variant ``SIZE``.
        needed_mps: smallest and median J / m in [m/s] that count as good; no paper prints any.
        what: for the text.
    """
    reference = speeds_mps(limits[limits["variant"] == "reference"])
    minimum, median = float(reference.min()), float(reference.median())
    holds = minimum >= needed_mps[0] and median >= needed_mps[1]
    weak = int((reference < needed_mps[0]).sum())
    aim = f"{needed_mps[0]:g} / {needed_mps[1]:g} m/s aimed at here"
    why = "" if holds else f"Below the {aim}; {weak} cases are below {needed_mps[0]:g}."
    at_one_size = table[table["variant"] == SIZE]
    text = f"largest push survived ({what}), minimum / median J/m [m/s]"
    ours = f"{_of_both(reference)}, {len(reference)} cases"
    first = Claim(text, "not printed", ours, Verdict.NEW, " ".join(filter(None, [why, _smaller_falls(at_one_size)])))
    one_size = survival(f"stays up {SIZE} in every case ({what})", at_one_size, "not printed")
    return [first, one_size, *_variant_claims(limits, text)]


def _of_both(speeds: "pd.Series[float]") -> str:
    return f"{limit_text(speeds.min(), 2)} / {limit_text(speeds.median(), 2)}"


def _smaller_falls(at_one_size: pd.DataFrame) -> str:
    """Return in which cases a push of that size fells the robot, as a sentence; nothing if it does in none."""
    fell = at_one_size.drop(completed(at_one_size).index)
    cases = [f"{direction} deg at {start_s:g} s" for direction, start_s in fell[CASE].itertuples(index=False)]
    if not cases:
        return ""
    found = f"{SIZE} it falls in {len(cases)} of {len(at_one_size)} ({', '.join(cases)})."
    return f"The search tries few sizes and overstates: {found}"


def _variant_claims(limits: pd.DataFrame, text: str) -> list[Claim]:
    claims = []
    for level, name in VARIANTS.items():
        rows = limits[limits["variant"] == level]
        if len(rows):
            speeds, whole = speeds_mps(rows), speeds_mps(same_cases(limits, rows))
            ours = f"{_of_both(speeds)}, {len(speeds)} cases; reference there {_of_both(whole)}"
            claims.append(Claim(f"{text}: {name}", "not printed", ours, Verdict.NEW))
    return claims


def same_cases(limits: pd.DataFrame, rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of the reference at the directions and phases of ``rows``: others are harder or easier."""
    reference = limits[limits["variant"] == "reference"]
    return reference.merge(rows[CASE], on=CASE, validate="one_to_one")
