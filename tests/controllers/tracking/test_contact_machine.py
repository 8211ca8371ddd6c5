"""Scripted forces under the feet: which leg stands, swings or searches, and on which foothold."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from controller_cases import gait_schedule, tracking_config

from quadlab.controllers.telemetry import LegMode
from quadlab.controllers.tracking.contact_machine import ContactMachine, start_contacts
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array

STANCE, SWING, SEARCH = LegMode.STANCE, LegMode.SWING, LegMode.SEARCH
PERIOD, WEIGHT = 0.0025, 400.0  # [s], [N]
FEET = np.array([[0.3, 0.2, 0.0], [0.3, -0.2, 0.0], [-0.3, 0.2, 0.0], [-0.3, -0.2, 0.0]])
LF, RF, LH, RH = range(4)
Loads = Callable[[float], Sequence[bool]]


def one_leg_schedule() -> ContactSchedule:
    """LF is in the air over [0.2, 0.5], [0.8, 1.1] and [1.4, 1.7]; the others stand."""
    contacts = np.ones((7, 4), dtype=bool)
    contacts[1::2, LF] = False
    return ContactSchedule(np.full(7, 0.3) - np.array([0.1, *np.zeros(6)]), contacts)


def diagonal_schedule() -> ContactSchedule:
    """LF and RH are in the air over [0.2, 0.5]."""
    contacts = np.ones((3, 4), dtype=bool)
    contacts[1, [LF, RH]] = False
    return ContactSchedule(np.array([0.2, 0.3, 0.3]), contacts)


def machine_for(schedule: ContactSchedule, **changes: Any) -> ContactMachine:
    return start_contacts(tracking_config(contact=changes).contact, schedule, WEIGHT, FEET)


@dataclass
class Script:
    """Runs a machine and remembers when its modes changed.

    Attributes:
        machine: under test.
        time_s: plan time of the last tick.
        changes: (time, leg, new mode).
        events: (time, text).
    """

    machine: ContactMachine
    time_s: float = 0.0
    changes: list[tuple[float, int, LegMode]] = field(default_factory=list)
    events: list[tuple[float, str]] = field(default_factory=list)

    def run(self, until: float, loaded: Loads, feet: Array = FEET) -> "Script":
        """Tick on to ``until`` with forces as ``loaded`` says."""
        while self.time_s < until - 1e-9:
            modes = self.modes
            forces = 0.25 * WEIGHT * np.array(loaded(self.time_s), dtype=float)
            events = self.machine.update(self.time_s, PERIOD, feet, forces)
            self.events += [(self.time_s, event) for event in events]
            self.changes += [(self.time_s, leg, mode) for leg, mode in enumerate(self.modes) if mode is not modes[leg]]
            self.time_s += PERIOD
        return self

    @property
    def modes(self) -> list[LegMode]:
        """Present mode of each leg."""
        return [leg.mode for leg in self.machine.legs]

    def changes_of(self, leg: int) -> list[tuple[Any, LegMode]]:
        """(time, to one tick, and new mode) of each change of one leg."""
        return [(pytest.approx(time, abs=1.1 * PERIOD), mode) for time, number, mode in self.changes if number == leg]


def loaded_but(leg: int, start: float, end: float) -> Loads:
    """All feet carry load but ``leg`` in [start, end)."""

    def loads(time: float) -> list[bool]:
        return [number != leg or not start - 1e-9 <= time < end - 1e-9 for number in range(4)]

    return loads


def test_leg_follows_the_schedule_when_the_ground_is_where_it_was_planned() -> None:
    script = Script(machine_for(one_leg_schedule())).run(0.7, loaded_but(LF, 0.21, 0.4975))
    assert script.changes_of(LF) == [(0.2, SWING), (0.4975, STANCE)]
    assert script.machine.legs[LF].foothold == 1
    assert script.events == []
    assert all(script.modes[leg] is STANCE for leg in (RF, LH, RH))


def test_early_touch_down_ends_the_swing() -> None:
    script = Script(machine_for(one_leg_schedule())).run(0.6, loaded_but(LF, 0.21, 0.41))
    assert script.changes_of(LF) == [(0.2, SWING), (0.41, STANCE)]
    assert script.machine.legs[LF].foothold == 1
    assert [text for _, text in script.events] == ["LF early touch-down at 0.70 of the swing"]


def test_touch_before_the_earliest_touch_down_is_ignored() -> None:
    """A scuff at lift-off is not a touch-down."""

    def scuffs(time: float) -> list[bool]:
        return [time < 0.3 or time > 0.4975, True, True, True]

    script = Script(machine_for(one_leg_schedule(), earliest_touch_down=0.5)).run(0.6, scuffs)
    assert script.changes_of(LF) == [(0.2, SWING), (0.5, STANCE)]
    assert script.machine.legs[LF].foothold == 1


def test_late_foot_goes_down_until_it_finds_the_ground() -> None:
    script = Script(machine_for(one_leg_schedule(), search_speed_mps=0.4))
    script.run(0.55, loaded_but(LF, 0.21, 0.6))
    assert script.modes[LF] is SEARCH
    assert script.machine.searching
    assert script.machine.legs[LF].foothold == 0
    assert script.machine.legs[LF].search_depth == pytest.approx(0.4 * 0.05, abs=0.4 * 2 * PERIOD)
    script.run(0.7, loaded_but(LF, 0.21, 0.6))
    assert script.changes_of(LF) == [(0.2, SWING), (0.5, SEARCH), (0.6, STANCE)]
    assert script.machine.legs[LF].foothold == 1
    texts = [text for _, text in script.events]
    assert texts == ["LF late: no touch-down at the end of the swing", "LF ground found 40 mm down"]


def test_depth_of_the_search_only_grows() -> None:
    script = Script(machine_for(one_leg_schedule())).run(0.5, loaded_but(LF, 0.21, 9.0))
    depths = []
    while script.time_s < 0.7:
        script.run(script.time_s + PERIOD, loaded_but(LF, 0.21, 9.0))
        depths.append(script.machine.legs[LF].search_depth)
    np.testing.assert_allclose(np.diff(depths), script.machine.config.search_speed_mps * PERIOD, rtol=1e-9)


def test_search_joins_the_next_swing() -> None:
    script = Script(machine_for(one_leg_schedule())).run(1.2, loaded_but(LF, 0.21, 1.0975))
    assert script.changes_of(LF) == [(0.2, SWING), (0.5, SEARCH), (0.8, SWING), (1.0975, STANCE)]
    assert script.machine.legs[LF].foothold == 2


def test_lost_contact_starts_a_search_that_keeps_the_foothold() -> None:
    script = Script(machine_for(one_leg_schedule(), lost_contact_s=0.02)).run(0.15, loaded_but(RH, 0.05, 0.1))
    assert script.changes_of(RH) == [(0.07, SEARCH), (0.1, STANCE)]
    assert script.machine.legs[RH].foothold == 0
    assert script.events[0][1] == "RH lost contact"


def test_short_loss_of_contact_is_no_loss() -> None:
    """Unloaded time does not add up over separate losses."""

    def flickers(time: float) -> list[bool]:
        return [True, True, True, round(time / PERIOD) % 8 == 0]

    assert Script(machine_for(one_leg_schedule(), lost_contact_s=0.02)).run(0.19, flickers).changes == []


def test_bouncing_foot_settles_before_its_contact_can_be_lost() -> None:
    """A foot that touches once and bounces is given the settling time."""

    def bounces(time: float) -> list[bool]:
        return [time < 0.21 or abs(time - 0.48) < 1e-6, True, True, True]

    script = Script(machine_for(one_leg_schedule(), lost_contact_s=0.02, settling_s=0.06)).run(0.6, bounces)
    assert script.changes_of(LF) == [(0.2, SWING), (0.48, STANCE), (0.5425, SEARCH)]


def test_leg_that_carries_the_robot_does_not_search() -> None:
    """With too few others standing a leg without force stays: nobody else could take over."""
    script = Script(machine_for(diagonal_schedule(), minimum_stance_legs=2))

    def only_one_standing(time: float) -> list[bool]:
        return [False, time < 0.25, True, False] if time > 0.21 else [True] * 4

    script.run(0.45, only_one_standing)
    assert script.modes == [SWING, STANCE, STANCE, SWING]


def unsupported(return_s: float) -> Loads:
    """RF carries nothing from 0.1 s to ``return_s``; LF and RH are in the air after their planned lift-off."""

    def loads(time: float) -> list[bool]:
        return [time < 0.21, not 0.1 <= time < return_s, True, True]

    return loads


def test_lift_off_waits_until_enough_others_stand() -> None:
    """RH may not leave while RF searches and LF swings; it leaves once RF stands again."""
    script = Script(machine_for(diagonal_schedule(), minimum_stance_legs=2)).run(0.35, unsupported(0.3))
    assert script.changes_of(RF) == [(0.12, SEARCH), (0.3, STANCE)]
    assert script.changes_of(RH) == [(0.3, SWING)]
    leg = script.machine.legs[RH]
    assert leg.lift_off_s == pytest.approx(0.3, abs=1.1 * PERIOD)
    assert leg.touch_down_due_s == pytest.approx(0.5)
    assert leg.swing_phase(0.4) == pytest.approx(0.5, abs=0.01)


def test_lift_off_that_had_to_wait_too_long_is_skipped() -> None:
    machine = machine_for(diagonal_schedule(), minimum_stance_legs=2, latest_lift_off=0.7)
    script = Script(machine).run(0.5, unsupported(0.45))
    assert script.changes_of(RH) == []
    assert machine.legs[RH].foothold == 1
    ((time, text),) = [event for event in script.events if event[1].startswith("RH")]
    assert text == "RH swing skipped: too few other legs stood"
    assert time == pytest.approx(0.2 + 0.7 * 0.3, abs=1.5 * PERIOD)


def test_slipping_foot_moves_its_stance_point() -> None:
    machine = machine_for(one_leg_schedule(), slip_m=0.02)
    forward = np.array([1.0, 0.0, 0.0])
    nudged, slipped = FEET + 0.015 * forward, FEET + 0.03 * forward
    script = Script(machine).run(0.05, lambda _: [True] * 4, nudged)
    np.testing.assert_array_equal(machine.legs[RH].stance_point, FEET[RH])
    script.run(0.1, lambda _: [True] * 4, slipped)
    np.testing.assert_array_equal(machine.legs[RH].stance_point, slipped[RH])


def test_points_of_lift_off_and_touch_down_are_measured() -> None:
    machine = machine_for(one_leg_schedule())
    script = Script(machine).run(0.25, lambda _: [True] * 4)
    np.testing.assert_array_equal(machine.legs[LF].lift_off_point, FEET[LF])
    landed = FEET + np.array([0.1, 0.0, 0.03])
    script.run(0.6, loaded_but(LF, 0.2, 0.48), landed)
    np.testing.assert_array_equal(machine.legs[LF].stance_point, landed[LF])


def random_loads(generator: np.random.Generator, schedule: ContactSchedule) -> Loads:
    """Load as planned, turned over for random spells."""
    spells = [
        (leg, start, start + length)
        for leg, start, length in zip(
            generator.integers(0, 4, 30),
            generator.uniform(0.0, schedule.duration_s, 30),
            generator.exponential(0.12, 30),
            strict=True,
        )
    ]

    def loads(time: float) -> list[bool]:
        planned = schedule.contacts_at(time).copy()
        for leg, start, end in spells:
            if start <= time < end:
                planned[leg] = not planned[leg]
        return [bool(flag) for flag in planned]

    return loads


@pytest.mark.parametrize("gait", ["trot", "walk"])
@pytest.mark.parametrize("seed", range(6))
def test_footholds_stay_in_step_with_the_schedule(gait: str, seed: int) -> None:
    """Whatever the feet feel: a standing leg is on a foothold it has reached by plan, and no foothold is revisited."""
    schedule = gait_schedule(gait, {"trot": 4.5, "walk": 12.5}[gait])
    script = Script(machine_for(schedule))
    loads = random_loads(np.random.default_rng(seed), schedule)
    before = [0] * 4
    while script.time_s < schedule.duration_s:
        now = script.time_s
        script.run(now + PERIOD, loads)
        for number, leg in enumerate(script.machine.legs):
            completed, swing = schedule.swing_at(number, now)
            assert leg.foothold in allowed_footholds(leg.mode, leg.completes_swing, completed, swing is not None)
            assert before[number] <= leg.foothold <= len(schedule.swings[number])
            assert leg.mode is not SWING or leg.lift_off_s <= now <= leg.touch_down_due_s + PERIOD
        before = [leg.foothold for leg in script.machine.legs]


def allowed_footholds(mode: LegMode, completes_swing: bool, completed: int, in_swing: bool) -> set[int]:
    if mode is SWING:
        return {completed}
    if mode is SEARCH and completes_swing:
        return {completed - 1}
    return {completed, completed + 1} if in_swing else {completed}


@pytest.mark.parametrize("seed", range(6))
def test_enough_legs_stand_whatever_the_feet_feel(seed: int) -> None:
    schedule = gait_schedule("trot", 4.5)
    script = Script(machine_for(schedule, minimum_stance_legs=2))
    loads = random_loads(np.random.default_rng(seed), schedule)
    while script.time_s < schedule.duration_s:
        script.run(script.time_s + PERIOD, loads)
        assert script.machine.stance.sum() >= 2
