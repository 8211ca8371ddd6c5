"""Trials with the priorities of the paper are judged by what the paper reports, our variants are new."""

import pandas as pd
import pytest

from paper_figures.trial_claims import PAPER_STACK, PAPER_STACK_WHY, paper_stack, variant_claims
from quadlab.analysis.artefact import Verdict


def _rows(*statuses: str) -> pd.DataFrame:
    return pd.DataFrame({"variant": PAPER_STACK, "status": list(statuses)})


@pytest.mark.parametrize(
    ("statuses", "verdict", "why"),
    [
        (("completed", "completed"), Verdict.REPRODUCED, ""),
        (("completed", "fell"), Verdict.PARTLY, PAPER_STACK_WHY),
        (("fell", "fell"), Verdict.NOT, PAPER_STACK_WHY),
    ],
)
def test_falls_with_the_priorities_of_the_paper_count(statuses: tuple[str, ...], verdict: Verdict, why: str) -> None:
    claim = paper_stack(_rows(*statuses), "recovers")
    assert (claim.verdict, claim.why) == (verdict, why)


def test_variants_are_ours_alone() -> None:
    rows = pd.concat([_rows("fell"), pd.DataFrame([("alignment none", "fell")], columns=["variant", "status"])])
    assert [claim.verdict for claim in variant_claims(rows)] == [Verdict.NEW]
