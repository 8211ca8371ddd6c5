"""What is said of the largest pushes: falls count as zero, and variants are compared at the same cases."""

import pandas as pd
import pytest

from paper_figures.push_limits import ANYMAL_KG, PUSH_S, SIZE, limit_claims, same_cases, speeds_mps

START = "scenario.pushes.0.start_s"
LIMITS = pd.DataFrame(
    [("reference", 0, 1.8, 300.0), ("reference", 90, 1.8, 120.0), ("alignment none", 90, 1.8, None)],
    columns=["variant", "direction", START, "limit"],
)
TRIALS = pd.DataFrame(
    [(SIZE, 0, 1.8, "completed"), (SIZE, 90, 1.8, "fell"), ("reference", 0, 1.8, "fell")],
    columns=["variant", "direction", START, "status"],
)
STANDING = TRIALS.assign(status="completed")


def test_push_that_fells_at_once_counts_as_zero() -> None:
    assert speeds_mps(LIMITS).tolist() == pytest.approx([300.0 * PUSH_S / ANYMAL_KG, 120.0 * PUSH_S / ANYMAL_KG, 0.0])


def test_variant_stands_beside_the_reference_at_its_own_cases() -> None:
    variant = LIMITS[LIMITS["variant"] == "alignment none"]
    assert same_cases(LIMITS, variant)["limit"].tolist() == [120.0]
    _, _, claim = limit_claims(LIMITS, TRIALS, (0.5, 1.0), "trot")
    assert claim.ours == "none / none, 1 cases; reference there 0.59 / 0.59"


@pytest.mark.parametrize(
    ("needed", "why"), [((0.5, 1.0), ""), ((0.6, 1.0), "1 cases are below 0.6"), ((0.5, 2.0), "0 cases")]
)
def test_missing_the_aim_is_said(needed: tuple[float, float], why: str) -> None:
    claim = limit_claims(LIMITS, STANDING, needed, "trot")[0]
    assert why in claim.why
    assert bool(claim.why) == bool(why)


def test_falls_at_one_size_are_named_beside_the_minimum() -> None:
    claim = limit_claims(LIMITS, TRIALS, (0.5, 1.0), "trot")[0]
    assert "at 0.6 m/s it falls in 1 of 2 (90 deg at 1.8 s)" in claim.why


def test_all_cases_at_one_size_stand_beside_the_largest_pushes() -> None:
    claim = limit_claims(LIMITS, TRIALS, (0.5, 1.0), "trot")[1]
    assert claim.text == "stays up at 0.6 m/s in every case (trot)"
    assert claim.ours.startswith("1 of 2 ")
