"""A trot that turns goes on turning, and stays off the path without pushes by as much as it came off it."""

import numpy as np
import pandas as pd
import pytest

from paper_figures.gehring2017.figure7_turning_trot import (
    PAIRS,
    PUSHED,
    deviation,
    last_stride,
    settling,
    turned,
    yaw_change,
)
from quadlab.analysis.artefact import Verdict
from quadlab.gaits.schedule import ContactSchedule
from quadlab.plotting.intervals import Interval

TIMES = np.arange(0, 800) / 100.0
STRIDE = Interval(6.0, 6.8)


def _trials(
    turn_deg: float, bump_deg: float = 0.0, end_m: float = 0.5, drift_mps: float = 0.0
) -> dict[str, pd.DataFrame]:
    """Return trials that turn, and go off by ``end_m`` with a push at 4 s, and on by ``drift_mps``."""
    late = TIMES >= 4.0

    def trial(pushed: bool) -> pd.DataFrame:
        yaw = turn_deg * TIMES / TIMES[-1] + pushed * bump_deg * (late & (TIMES < 5.0))
        x = pushed * late * (end_m + drift_mps * (TIMES - 4.0))
        return pd.DataFrame({"yaw_deg": yaw, "base_x_m": x, "base_y_m": 0.0}, index=TIMES)

    return {**{name: trial(True) for name in PUSHED}, **{name: trial(False) for name in PAIRS.values()}}


@pytest.mark.parametrize(
    ("turn_deg", "verdict"), [(161.0, Verdict.REPRODUCED), (145.0, Verdict.NOT), (0.0, Verdict.NOT)]
)
def test_turns_by_the_angle_of_every_stride(turn_deg: float, verdict: Verdict) -> None:
    assert turned(_trials(turn_deg), 8).verdict is verdict


@pytest.mark.parametrize(("bump_deg", "verdict"), [(1.3, Verdict.REPRODUCED), (-6.0, Verdict.NOT)])
def test_pushes_do_not_show_in_yaw(bump_deg: float, verdict: Verdict) -> None:
    claim = yaw_change(_trials(160.0, bump_deg))
    assert claim.verdict is verdict
    assert claim.ours.startswith(f"{abs(bump_deg):.1f}")


@pytest.mark.parametrize(("end_m", "verdict"), [(0.5, Verdict.REPRODUCED), (0.01, Verdict.NOT)])
def test_pushes_show_in_the_path(end_m: float, verdict: Verdict) -> None:
    assert deviation(_trials(160.0, end_m=end_m)).verdict is verdict


def test_last_stride_ends_with_the_last_touch_down() -> None:
    stand, diagonal = np.ones(4, dtype=bool), np.array([True, False, False, True])
    phases = np.array([stand, *(stand, ~diagonal, stand, diagonal) * 2, stand])
    schedule = ContactSchedule(np.full(len(phases), 0.2), phases)
    assert last_stride(schedule) == pytest.approx((1.0, 1.8))


@pytest.mark.parametrize(("drift_mps", "verdict"), [(0.0, Verdict.REPRODUCED), (0.5, Verdict.NOT)])
def test_a_deviation_that_grows_has_not_settled(drift_mps: float, verdict: Verdict) -> None:
    assert settling(_trials(160.0, drift_mps=drift_mps), STRIDE).verdict is verdict
