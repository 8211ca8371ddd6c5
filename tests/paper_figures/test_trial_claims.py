"""Trials with the priorities of the paper are judged by what the paper reports, our variants are new."""

import pandas as pd
import pytest

from paper_figures.trial_claims import (
    FEWEST_TRIALS,
    PAPER_STACK,
    PAPER_STACK_WHY,
    TOO_FEW,
    paper_stack,
    survival,
    variant_claims,
)
from quadlab.analysis.artefact import Verdict


def _rows(*statuses: str) -> pd.DataFrame:
    return pd.DataFrame({"variant": PAPER_STACK, "status": list(statuses)})


@pytest.mark.parametrize(
    ("statuses", "verdict", "why"),
    [
        (("completed",) * 5, Verdict.REPRODUCED, ""),
        (("completed", *("fell",) * 4), Verdict.PARTLY, PAPER_STACK_WHY),
        (("fell",) * 5, Verdict.NOT, PAPER_STACK_WHY),
    ],
)
def test_falls_with_the_priorities_of_the_paper_count(statuses: tuple[str, ...], verdict: Verdict, why: str) -> None:
    claim = paper_stack(_rows(*statuses), "recovers")
    assert (claim.verdict, claim.why) == (verdict, why)


@pytest.mark.parametrize(("status", "verdict"), [("completed", Verdict.PARTLY), ("fell", Verdict.NOT)])
def test_few_trials_reproduce_nothing(status: str, verdict: Verdict) -> None:
    claim = survival("walks", _rows(*(status,) * (FEWEST_TRIALS - 1)), "recovers")
    assert (claim.verdict, claim.why) == (verdict, TOO_FEW)


def test_few_trials_of_which_no_paper_speaks_are_new() -> None:
    claim = survival("walks", _rows("completed"), "not printed")
    assert (claim.verdict, claim.why) == (Verdict.NEW, "")


def test_variants_are_ours_alone() -> None:
    rows = pd.concat([_rows("fell"), pd.DataFrame([("alignment none", "fell")], columns=["variant", "status"])])
    assert [claim.verdict for claim in variant_claims(rows)] == [Verdict.NEW]
