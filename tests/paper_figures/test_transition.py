"""A picture of the transition is named after the legs that touch down in it, or else that are in the air."""

import numpy as np
import pandas as pd

from paper_figures.gehring2017.figure8_transition import moment
from quadlab.robots.legs import LEGS

TIMES = np.arange(0.0, 1.0, 0.02)


def _trace() -> pd.DataFrame:
    """Return contacts of which LF and RH swing from 0.2 to 0.6 s."""
    stands = (TIMES < 0.2) | (TIMES >= 0.6)
    return pd.DataFrame(
        {f"control.planned_contact_{leg}": stands | (leg in ("RF", "LH")) for leg in LEGS}, index=TIMES, dtype=float
    )


def test_legs_in_the_air_are_at_their_apex() -> None:
    assert moment(_trace(), 0.4) == "apex LF RH"


def test_legs_that_land_touch_down() -> None:
    assert moment(_trace(), 0.6) == "touch-down LF RH"
