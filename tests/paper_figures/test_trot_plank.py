"""Pitch and feet adapt to a plank if both turn out as they would on one; walk and trot share their settings."""

import numpy as np
import pandas as pd
import pytest

from paper_figures.gehring2017.figure6_trot_plank import feet_adapt, pitch_adapts, plank_height_m, same_settings
from quadlab.analysis.artefact import Verdict
from quadlab.robots.legs import LEGS

TIMES = np.arange(0, 400) / 100.0
HEIGHT_M = 0.08


def _curves(fore_deg: float, hind_deg: float, height_m: float, apex_m: float) -> pd.DataFrame:
    """Return RF and RH on the plank from 1 to 2 s and from 2 to 3 s, and one swing of each leg, of RF higher."""
    rf, rh, swings = (TIMES >= 1.0) & (TIMES < 2.0), (TIMES >= 2.0) & (TIMES < 3.0), (TIMES >= 3.0) & (TIMES < 3.5)
    on_plank = dict.fromkeys(LEGS, np.zeros(len(TIMES), bool)) | {"RF": rf, "RH": rh}
    return pd.DataFrame(
        {
            "time_s": TIMES,
            "pitch_reference_deg": np.where(rf, fore_deg, np.where(rh, hind_deg, 0.0)),
            **{f"{leg}_on_plank": on_plank[leg].astype(int) for leg in LEGS},
            **{f"{leg}_z_m": np.where(on_plank[leg], height_m, 0.0) for leg in LEGS},
            **{f"{leg}_z_reference_m": np.where(swings, apex_m if leg == "RF" else 0.12, np.nan) for leg in LEGS},
        }
    )


@pytest.mark.parametrize(
    ("fore_deg", "hind_deg", "verdict"),
    [(-2.6, 2.9, Verdict.REPRODUCED), (-2.6, 0.1, Verdict.PARTLY), (0.0, 0.0, Verdict.NOT), (2.6, -2.9, Verdict.NOT)],
)
def test_pitch_turns_up_with_the_fore_feet_and_down_with_the_hind_feet(
    fore_deg: float, hind_deg: float, verdict: Verdict
) -> None:
    assert pitch_adapts(_curves(fore_deg, hind_deg, HEIGHT_M, 0.2)).verdict is verdict


@pytest.mark.parametrize(
    ("height_m", "apex_m", "verdict"),
    [
        (0.079, 0.2, Verdict.REPRODUCED),
        (0.079, 0.12, Verdict.PARTLY),
        (0.06, 0.2, Verdict.PARTLY),
        (0.06, 0.12, Verdict.NOT),
    ],
)
def test_feet_stand_and_swing_higher(height_m: float, apex_m: float, verdict: Verdict) -> None:
    claim = feet_adapt(_curves(-2.6, 2.9, height_m, apex_m), HEIGHT_M)
    assert claim.verdict is verdict
    assert claim.ours.startswith(f"RF {1e3 * height_m:.0f}, RH {1e3 * height_m:.0f} of 80; ")


def test_a_foot_that_brushes_the_plank_does_not_stand_on_it() -> None:
    curves = _curves(-2.6, 2.9, HEIGHT_M, 0.2)
    curves["LF_on_plank"] = ((TIMES >= 1.0) & (TIMES < 1.03)).astype(int)
    assert "LF" not in feet_adapt(curves, HEIGHT_M).ours


def test_height_is_that_of_the_kept_trial() -> None:
    assert plank_height_m() == HEIGHT_M


def test_walk_and_trot_share_planner_and_controller() -> None:
    claim = same_settings()
    assert claim.verdict is Verdict.REPRODUCED
    assert claim.ours.startswith("0 of ")
