"""What is left of a schedule is the schedule, later."""

import numpy as np
import pytest

from quadlab.errors import QuadlabError
from quadlab.gaits.schedule import ContactSchedule

FLAGS = [[1, 1, 1, 1], [0, 1, 1, 0], [1, 1, 1, 1], [1, 0, 0, 1], [1, 1, 1, 1]]
SCHEDULE = ContactSchedule(np.array([0.5, 0.4, 0.1, 0.4, 0.6]), np.array(FLAGS, dtype=bool))


@pytest.mark.parametrize("cut_s", [0.0, 0.3, 0.5, 0.7, 0.9, 1.99])
def test_contacts_are_those_of_later_times(cut_s: float) -> None:
    rest = SCHEDULE.after(cut_s)
    assert rest.duration_s == pytest.approx(SCHEDULE.duration_s - cut_s)
    for time in np.arange(cut_s + 1e-3, SCHEDULE.duration_s, 0.007):
        np.testing.assert_array_equal(rest.contacts_at(time - cut_s), SCHEDULE.contacts_at(time))


def test_swing_under_way_keeps_its_end() -> None:
    (swing,) = SCHEDULE.after(0.7).swings[0]
    assert swing.start_s == 0.0
    assert swing.end_s == pytest.approx(0.2)
    assert len(SCHEDULE.after(0.95).swings[0]) == 0


def test_nothing_is_left_at_the_end() -> None:
    with pytest.raises(QuadlabError, match=r"nothing is left at 2 s"):
        SCHEDULE.after(2.0)
