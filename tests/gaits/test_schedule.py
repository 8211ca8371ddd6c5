"""Queries on contact schedules."""

import numpy as np
import pytest

from quadlab.gaits.schedule import ContactSchedule, Swing

#                       phase  0 stand    1 LF up    2 LF and RH up   3 stand
CONTACTS = np.array([[1, 1, 1, 1], [0, 1, 1, 1], [0, 1, 1, 0], [1, 1, 1, 1]], dtype=bool)
SCHEDULE = ContactSchedule(np.array([0.5, 0.2, 0.3, 1.0]), CONTACTS)


def test_switch_times_are_cumulated_durations() -> None:
    np.testing.assert_allclose(SCHEDULE.switch_times_s, [0.0, 0.5, 0.7, 1.0, 2.0])
    assert SCHEDULE.duration_s == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("time_s", "phase"), [(-1.0, 0), (0.0, 0), (0.49, 0), (0.5, 1), (0.6999, 1), (0.7, 2), (1.0, 3), (2.0, 3), (9.0, 3)]
)
def test_a_switch_belongs_to_the_phase_that_begins(time_s: float, phase: int) -> None:
    assert SCHEDULE.phase_at(time_s) == phase
    np.testing.assert_array_equal(SCHEDULE.contacts_at(time_s), CONTACTS[phase])


def test_phases_in_the_air_that_follow_each_other_are_one_swing() -> None:
    assert [len(swings) for swings in SCHEDULE.swings] == [1, 0, 0, 1]
    assert SCHEDULE.swings[0][0].start_s == pytest.approx(0.5)
    assert SCHEDULE.swings[0][0].end_s == pytest.approx(1.0)
    assert SCHEDULE.swings[3][0].duration_s == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("time_s", "completed", "in_air"),
    [(0.0, 0, False), (0.5, 0, True), (0.99, 0, True), (1.0, 1, False), (5.0, 1, False)],
)
def test_swing_at(time_s: float, completed: int, in_air: bool) -> None:
    count, swing = SCHEDULE.swing_at(0, time_s)
    assert count == completed
    assert (swing is not None) is in_air
    assert SCHEDULE.swing_at(1, time_s) == (0, None)


def test_swing_duration() -> None:
    assert Swing(0.25, 1.0).duration_s == pytest.approx(0.75)


def test_swing_at_agrees_with_contacts_everywhere() -> None:
    for time in np.linspace(0.0, 2.0, 401):
        flags = SCHEDULE.contacts_at(float(time))
        for leg in range(4):
            assert (SCHEDULE.swing_at(leg, float(time))[1] is None) == flags[leg]
