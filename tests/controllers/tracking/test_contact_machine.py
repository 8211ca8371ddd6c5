"""Scripted forces under the feet: touch-down, lost contact and search."""

import numpy as np
import pytest
from contact_scripts import (
    FEET,
    LF,
    LH,
    PERIOD,
    RF,
    RH,
    SEARCH,
    STANCE,
    SWING,
    WEIGHT,
    Script,
    diagonal_schedule,
    loaded_but,
    machine_for,
    one_leg_schedule,
)

from quadlab.controllers.telemetry import LegMode


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


def test_slipping_foot_moves_its_stance_point() -> None:
    machine = machine_for(one_leg_schedule(), slip_m=0.02)
    forward = np.array([1.0, 0.0, 0.0])
    nudged, slipped = FEET + 0.015 * forward, FEET + 0.03 * forward
    script = Script(machine).run(0.05, lambda _: [True] * 4, nudged)
    np.testing.assert_array_equal(machine.legs[RH].stance_point, FEET[RH])
    script.run(0.1, lambda _: [True] * 4, slipped)
    np.testing.assert_array_equal(machine.legs[RH].stance_point, slipped[RH])


def test_points_of_lift_off_and_touch_down_are_measured() -> None:
    machine = machine_for(one_leg_schedule(), slip_m=1.0)
    nudged = FEET + np.array([0.01, 0.0, 0.0])
    script = Script(machine).run(0.25, lambda _: [True] * 4, nudged)
    np.testing.assert_array_equal(machine.legs[LF].lift_off_point, nudged[LF])
    np.testing.assert_array_equal(machine.legs[LF].stance_point, nudged[LF])
    np.testing.assert_array_equal(machine.legs[RF].stance_point, FEET[RF])
    landed = FEET + np.array([0.1, 0.0, 0.03])
    script.run(0.6, loaded_but(LF, 0.2, 0.48), landed)
    np.testing.assert_array_equal(machine.legs[LF].stance_point, landed[LF])


def test_search_begins_where_the_foot_is_and_at_no_depth() -> None:
    machine = machine_for(one_leg_schedule(), slip_m=1.0)
    script = Script(machine).run(0.1, loaded_but(RH, 0.02, 0.08))
    moved = FEET + np.array([0.0, 0.0, 0.05])
    script.run(0.15, loaded_but(RH, 0.1, 9.0), moved)
    began_s = script.changes[-1][0]
    assert script.modes[RH] is SEARCH
    np.testing.assert_array_equal(machine.legs[RH].lift_off_point, moved[RH])
    expected = machine.config.search_speed_mps * (script.time_s - began_s)
    assert machine.legs[RH].search_depth == pytest.approx(expected, abs=2.0 * machine.config.search_speed_mps * PERIOD)


@pytest.mark.parametrize(("share", "mode"), [(0.026, SEARCH), (0.028, STANCE)])
def test_contact_is_a_share_of_the_weight(share: float, mode: LegMode) -> None:
    machine = machine_for(one_leg_schedule(), touch_down_force_share=0.027)
    for step in range(40):
        machine.update(step * PERIOD, PERIOD, FEET, WEIGHT * np.array([share, 0.3, 0.3, 0.3]))
    assert machine.legs[LF].mode is mode
