"""Legs that the balance cannot spare: lift-offs that wait and swings that hasten."""

import numpy as np
import pytest
from contact_scripts import (
    FEET,
    LF,
    LH,
    RF,
    RH,
    STANCE,
    SWING,
    Script,
    diagonal_schedule,
    loaded_but,
    machine_for,
    one_leg_schedule,
)

from quadlab.controllers.tracking.balance import Balance
from quadlab.gaits.schedule import ContactSchedule

PLANNED = np.array([-0.1, -0.1])  # over RF, LH and RH
HELD = Balance(FEET[:, :2], np.array([-0.05, -0.05]), PLANNED)
TOWARDS_LF = Balance(FEET[:, :2], np.array([0.1, 0.1]), PLANNED)


def test_lift_off_waits_until_the_capture_point_lies_over_the_others() -> None:
    script = Script(machine_for(one_leg_schedule()), TOWARDS_LF).run(0.3, loaded_but(LF, 9.0, 9.0))
    assert script.changes_of(LF) == []
    script.balance = HELD
    script.run(0.4, loaded_but(LF, 0.3, 9.0))
    assert script.changes_of(LF) == [(0.3, SWING)]
    assert script.machine.legs[LF].touch_down_due_s == pytest.approx(0.5)


def test_swing_hastens_when_the_capture_point_leaves_the_others() -> None:
    """From 0.3 s on, a third of the swing, the rest takes two thirds of 0.15 s; the phase does not jump."""
    machine = machine_for(one_leg_schedule(), hastened_swing_s=0.15)
    script = Script(machine, HELD).run(0.3, loaded_but(LF, 0.2, 9.0))
    script.balance = TOWARDS_LF
    before = machine.legs[LF].swing_phase(0.3)
    script.run(0.305, loaded_but(LF, 0.2, 9.0))
    assert machine.legs[LF].swing_phase(0.3) == pytest.approx(before)
    script.run(0.5, loaded_but(LF, 0.2, 0.395))
    assert script.changes_of(LF) == [(0.2, SWING), (0.395, STANCE)]
    assert machine.legs[LF].touch_down_due_s == pytest.approx(0.4)
    assert [text for _, text in script.events] == ["LF hastens at 0.33 of the swing"]


@pytest.mark.parametrize("start_s", np.arange(0.2, 20.0, 0.7))
def test_swing_hastens_once(start_s: float) -> None:
    """Also where the difference of two times is rounded up."""
    contacts = np.ones((3, 4), dtype=bool)
    contacts[1, LF] = False
    machine = machine_for(ContactSchedule(np.array([start_s, 1.0, 0.5]), contacts), hastened_swing_s=0.35)
    script = Script(machine, TOWARDS_LF, time_s=start_s)
    machine.legs[LF].mode = SWING
    machine.legs[LF].lift_off_s, machine.legs[LF].touch_down_due_s = start_s, start_s + 1.0
    script.run(start_s + 0.3, loaded_but(LF, 0.0, 99.0))
    assert len(script.events) == 1


def test_swing_as_short_as_a_hastened_one_is_left_alone() -> None:
    machine = machine_for(one_leg_schedule(), hastened_swing_s=0.35)
    script = Script(machine, HELD).run(0.3, loaded_but(LF, 0.2, 9.0))
    script.balance = TOWARDS_LF
    script.run(0.4, loaded_but(LF, 0.2, 9.0))
    assert machine.legs[LF].touch_down_due_s == pytest.approx(0.5)


def test_without_a_margin_the_schedule_rules() -> None:
    machine = machine_for(one_leg_schedule(), capture_margin_m=None, hastened_swing_s=0.15)
    script = Script(machine, TOWARDS_LF).run(0.4, loaded_but(LF, 0.2, 9.0))
    assert script.changes_of(LF) == [(0.2, SWING)]
    assert machine.legs[LF].touch_down_due_s == pytest.approx(0.5)


def test_gait_on_two_legs_is_held_by_its_next_step() -> None:
    script = Script(machine_for(diagonal_schedule()), TOWARDS_LF).run(0.3, loaded_but(LF, 9.0, 9.0))
    assert script.changes_of(LF) == [(0.2, SWING)]
    assert script.changes_of(RH) == [(0.2, SWING)]


def test_planned_capture_point_may_lie_outside_the_support() -> None:
    """Late in a swing the plan moves towards the foot in the air: following it is no reason to hasten."""
    planned = np.array([0.05, 0.05])
    near, far = np.array([0.06, 0.05]), np.array([0.08, 0.05])
    assert Balance(FEET[:, :2], near, planned).held_by([RF, LH, RH], 0.02)
    assert not Balance(FEET[:, :2], far, planned).held_by([RF, LH, RH], 0.02)


@pytest.mark.parametrize(("inside_m", "held"), [(0.03, True), (0.01, False), (-0.03, False)])
def test_capture_point_has_to_be_inside_by_the_margin(inside_m: float, held: bool) -> None:
    """RF, LH and RH: their longest edge goes through the origin, 0.3 forward and 0.2 to the right."""
    inwards = np.array([-0.2, -0.3]) / np.hypot(0.2, 0.3)
    assert Balance(FEET[:, :2], inside_m * inwards, PLANNED).held_by([RF, LH, RH], 0.02) is held
