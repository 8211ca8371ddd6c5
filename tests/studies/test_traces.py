"""Curves that are kept have the rate that was asked for, or less."""

import numpy as np
import pytest

from quadlab.studies.traces import ticks_between


@pytest.mark.parametrize(
    ("rate_hz", "kept_hz", "ticks"),
    [(400, 50, 8), (400, 100, 4), (400, 300, 2), (400, 400, 1), (400, 1000, 1), (600, 50, 12), (800, 100, 8)],
)
def test_rate_is_at_most_what_is_asked_for(rate_hz: int, kept_hz: float, ticks: int) -> None:
    times_s = np.arange(6000) / rate_hz
    assert ticks_between(times_s, kept_hz) == ticks
    assert ticks_between(np.round(times_s, 9), kept_hz) == ticks  # as in a log


def test_single_tick_is_kept() -> None:
    assert ticks_between(np.zeros(1), 50.0) == 1
