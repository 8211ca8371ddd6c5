"""Bars and marks say what the schedule and the log say."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from matplotlib.figure import Figure
from plotting_cases import GAITS, gait_schedule, scheduled_tick, straight_plan, write_trial
from synthetic_records import CONTROL_PERIOD

from quadlab.analysis.log_reader import read_log
from quadlab.controllers.telemetry import LegMode
from quadlab.controllers.tracking.config import ContactConfig
from quadlab.controllers.tracking.contact_machine import start_contacts
from quadlab.gaits.schedule import ContactSchedule
from quadlab.paths import CONF_DIR
from quadlab.plotting.axes.contact_bands import draw_contact_bands, planned_bands, recorded_bands
from quadlab.plotting.axes.pushes import recorded_pushes
from quadlab.plotting.intervals import Interval, intervals_where
from quadlab.plotting.leg_events import LegEventKind, leg_event
from quadlab.robots.legs import LEGS

PERIOD = 0.01  # [s]


@pytest.mark.parametrize(
    ("flags", "expected"),
    [
        ([0, 0, 0, 0], []),
        ([1, 1, 1, 1], [(0.0, 0.4)]),
        ([1, 0, 0, 1], [(0.0, 0.1), (0.3, 0.4)]),
        ([0, 1, 1, 0], [(0.1, 0.3)]),
    ],
)
def test_each_sample_holds_until_the_next(flags: list[int], expected: list[tuple[float, float]]) -> None:
    found = intervals_where(np.array([0.0, 0.1, 0.2, 0.3]), np.array(flags, bool), 0.4)
    assert found == [Interval(*bounds) for bounds in expected]


@pytest.mark.parametrize("gait", GAITS)
def test_bars_of_a_schedule_are_the_gaps_between_its_swings(gait: str) -> None:
    schedule = gait_schedule(gait)
    for bars, swings in zip(planned_bands(schedule).planned, schedule.swings, strict=True):
        edges = [0.0, *(edge for swing in swings for edge in (swing.start_s, swing.end_s)), schedule.duration_s]
        np.testing.assert_allclose([edge for bar in bars for edge in bar], edges, atol=1e-12)


@pytest.mark.parametrize("gait", GAITS)
def test_modes_of_a_log_become_the_bars_of_the_schedule(gait: str, tmp_path: Path) -> None:
    schedule = gait_schedule(gait)
    count = round(schedule.duration_s / PERIOD)
    ticks = [scheduled_tick(i, schedule, PERIOD, _modes(schedule, i * PERIOD)) for i in range(count)]
    log = read_log(write_trial(tmp_path, ticks, straight_plan(schedule)) / "trial.mcap")
    bands, expected = recorded_bands(log, count * PERIOD), planned_bands(schedule)
    for leg in range(4):
        for bars in (bands.planned[leg], bands.actual[leg]):
            np.testing.assert_allclose(bars, expected.planned[leg], atol=PERIOD)
    assert [len(bars) for bars in bands.searching] == [0, 0, 0, len(schedule.swings[3])]


def _modes(schedule: ContactSchedule, time_s: float) -> tuple[LegMode, ...]:
    in_air = (LegMode.SWING, LegMode.SWING, LegMode.SWING, LegMode.SEARCH)
    contacts = schedule.contacts_at(time_s)
    return tuple(LegMode.STANCE if stands else mode for stands, mode in zip(contacts, in_air, strict=True))


def test_rows_have_the_order_and_the_colours_of_the_legs() -> None:
    axes = Figure().subplots()
    draw_contact_bands(axes, planned_bands(gait_schedule("trot")))
    assert [label.get_text() for label in axes.get_yticklabels()] == list(LEGS)
    top, bottom = (axes.transData.transform((0.0, row))[1] for row in (0.0, 3.0))
    assert top > bottom


def test_pushes_come_from_the_forces_of_the_log(tmp_path: Path) -> None:
    schedule = gait_schedule("trot")
    ticks = [scheduled_tick(i, schedule, CONTROL_PERIOD, (LegMode.STANCE,) * 4) for i in range(40)]
    log = read_log(write_trial(tmp_path, ticks, straight_plan(schedule)) / "trial.mcap")
    (push,) = recorded_pushes(log, 40 * CONTROL_PERIOD)
    np.testing.assert_allclose(push.interval, (10 * CONTROL_PERIOD, 20 * CONTROL_PERIOD))
    np.testing.assert_array_equal(push.force, [0.0, 150.0, 0.0])
    assert push.label == "150 N, 4 N s"
    np.testing.assert_array_equal(push.com_position, log.control[["com_x", "com_y"]].iloc[10])


def test_what_the_controller_reports_is_understood() -> None:
    config = yaml.safe_load((CONF_DIR / "controller" / "hierarchical.yaml").read_text())["tracking"]["contact"]
    schedule = gait_schedule("trot")
    feet, loaded = np.zeros((4, 3)), np.full(4, 100.0)
    machine = start_contacts(ContactConfig.model_validate(config), schedule, 300.0, feet)
    messages: list[str] = []
    first, second = schedule.swings[0][:2]
    for time_s in np.arange(0.0, second.end_s + 0.1, CONTROL_PERIOD):
        in_air = 0.0 if time_s < first.start_s + 0.7 * first.duration_s or time_s > second.start_s else 100.0
        forces = loaded * schedule.contacts_at(time_s)
        forces[0] = 100.0 if schedule.contacts_at(time_s)[0] and time_s < second.start_s else in_air
        messages += machine.update(float(time_s), CONTROL_PERIOD, feet, forces)
    events = [event for message in messages if (event := leg_event(0.0, message)) is not None]
    assert {LegEventKind.EARLY_TOUCH_DOWN, LegEventKind.LATE_TOUCH_DOWN} <= {e.kind for e in events if e.leg == 0}


@pytest.mark.parametrize("message", ["push of 120 N starts", "completed: upright", "LF ground found 3 mm down"])
def test_other_messages_are_no_marks(message: str) -> None:
    assert leg_event(0.0, message) is None
