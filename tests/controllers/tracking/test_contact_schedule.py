"""Lift-offs that have to wait, and footholds and standing legs whatever the feet feel."""

import numpy as np
import pytest
from contact_scripts import (
    LF,
    PERIOD,
    RF,
    RH,
    SEARCH,
    STANCE,
    SWING,
    Loads,
    Script,
    diagonal_schedule,
    loaded_but,
    machine_for,
    one_leg_schedule,
)
from controller_cases import gait_schedule

from quadlab.controllers.telemetry import LegMode
from quadlab.gaits.schedule import ContactSchedule


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


def test_lift_off_waits_for_the_leg_that_shall_take_over() -> None:
    """Both hind legs stand, but a fore leg that the plan counts on searches: the other fore leg has to carry on."""
    script = Script(machine_for(one_leg_schedule(), minimum_stance_legs=2)).run(0.4, loaded_but(RF, 0.1, 0.3))
    assert script.changes_of(RF) == [(0.12, SEARCH), (0.3, STANCE)]
    assert script.changes_of(LF) == [(0.3, SWING)]
    assert script.machine.legs[LF].touch_down_due_s == pytest.approx(0.5)


def test_legs_of_a_pair_leave_together_when_the_other_pair_stands() -> None:
    """A leg that shall swing as well need not stand first; the pair leaves at once when the late foot has landed."""
    script = Script(machine_for(diagonal_schedule(), minimum_stance_legs=2)).run(0.35, loaded_but(RF, 0.1, 0.3))
    assert script.changes_of(LF) == [(0.3, SWING)]
    assert script.changes_of(RH) == [(0.3, SWING)]


def test_search_can_begin_before_the_swing_is_over_by_plan() -> None:
    """LF shall land after 80 % of its swing; from then on it searches."""
    script = Script(machine_for(diagonal_schedule(), expected_touch_down=0.8)).run(0.48, loaded_but(LF, 0.21, 0.6))
    swing = script.machine.schedule.swings[0][0]
    begins_s = swing.start_s + 0.8 * swing.duration_s
    searches = [time for time, mode in script.changes_of(0) if mode is SEARCH]
    assert searches == [pytest.approx(begins_s, abs=1.1 * PERIOD)]


def test_lift_off_that_had_to_wait_too_long_is_skipped() -> None:
    machine = machine_for(diagonal_schedule(), minimum_stance_legs=2, latest_lift_off=0.7)
    script = Script(machine).run(0.5, unsupported(0.45))
    assert script.changes_of(RH) == []
    assert machine.legs[RH].foothold == 1
    ((time, text),) = [event for event in script.events if event[1].startswith("RH")]
    assert text == "RH swing skipped"
    assert time == pytest.approx(0.2 + 0.7 * 0.3, abs=1.5 * PERIOD)


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
