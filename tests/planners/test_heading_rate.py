"""A heading that begins while the robot turns."""

import numpy as np
import pytest

from quadlab.planners.heading import heading_spline
from quadlab.planners.problem import Waypoints

TURN = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.3], [0.2, 0.0, 0.6]])


@pytest.mark.parametrize("rate", [0.0, 0.4, -0.2])
def test_heading_begins_with_the_given_rate_and_meets_its_waypoints(rate: float) -> None:
    heading = heading_spline(Waypoints(np.array([0.0, 1.0, 2.0]), TURN, rate))
    assert heading(0.0, 1)[0] == pytest.approx(rate)
    np.testing.assert_allclose([heading(t)[0] for t in (0.0, 1.0, 2.0)], TURN[:, 2], atol=1e-12)
    assert heading(2.0, 1)[0] == pytest.approx(0.0, abs=1e-9)
