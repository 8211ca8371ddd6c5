"""Normal-force limits that rise after touch-down and fall before lift-off."""

import math

import numpy as np
import pytest
from controller_cases import gait_schedule, standing_schedule, tracking_config

from quadlab.controllers.tracking.force_ramp import normal_force_limit, ramp_duration

WEIGHT, STANCE_S = 300.0, 0.45
CONFIG = tracking_config(
    force_ramp={"share_of_stance": 0.02, "maximum_weight_share": 2.0, "initial_weight_share": 0.1}
).force_ramp
RAMP_S = 0.02 * STANCE_S


def limit(since_touch_down_s: float) -> float:
    return normal_force_limit(CONFIG, WEIGHT, RAMP_S, since_touch_down_s, STANCE_S - since_touch_down_s)


def test_limit_rises_and_falls_within_two_percent_of_the_stance() -> None:
    assert limit(0.0) == pytest.approx(0.1 * WEIGHT)
    assert limit(0.01 * STANCE_S) == pytest.approx(1.05 * WEIGHT)
    for share in (0.02, 0.3, 0.5, 0.98):
        assert limit(share * STANCE_S) == pytest.approx(2.0 * WEIGHT)
    assert limit(0.99 * STANCE_S) == pytest.approx(1.05 * WEIGHT)
    assert limit(STANCE_S) == pytest.approx(0.1 * WEIGHT)


def test_limit_is_continuous_and_symmetric() -> None:
    times = np.linspace(0.0, STANCE_S, 4001)
    limits = np.array([limit(time) for time in times])
    steepest = 1.9 * WEIGHT / RAMP_S
    assert np.abs(np.diff(limits)).max() <= 1.001 * steepest * (times[1] - times[0])
    np.testing.assert_allclose(limits, limits[::-1], rtol=1e-9)


def test_leg_that_neither_landed_nor_will_leave_has_the_full_limit() -> None:
    assert normal_force_limit(CONFIG, WEIGHT, RAMP_S, math.inf, math.inf) == 2.0 * WEIGHT


def test_limit_rises_again_for_a_leg_whose_lift_off_must_wait() -> None:
    """It is needed on the ground."""
    limits = [normal_force_limit(CONFIG, WEIGHT, RAMP_S, 1.0, -late * RAMP_S) for late in (0.0, 0.5, 1.0, 9.0)]
    assert limits == pytest.approx([0.1 * WEIGHT, 1.05 * WEIGHT, 2.0 * WEIGHT, 2.0 * WEIGHT])


def test_no_ramp_is_a_constant_limit() -> None:
    for since in (0.0, 0.1):
        assert normal_force_limit(CONFIG, WEIGHT, 0.0, since, 0.5) == 2.0 * WEIGHT


@pytest.mark.parametrize(("gait", "duration_s", "stance_s"), [("trot", 5.0, 0.45), ("walk", 20.0, 5.0 * 13 / 16)])
def test_ramp_is_a_share_of_the_stance_between_swings(gait: str, duration_s: float, stance_s: float) -> None:
    schedule = gait_schedule(gait, duration_s)
    for leg in range(4):
        assert ramp_duration(CONFIG, schedule, leg, 1, 0.0) == pytest.approx(0.02 * stance_s)


def test_ramp_follows_the_gait() -> None:
    """Stances of a walk are longer than those of the trot that it becomes."""
    schedule = gait_schedule("walk_to_trot_cycles", 12.0)
    for leg in range(4):
        footholds = range(len(schedule.swings[leg]))
        ramps_s = [ramp_duration(CONFIG, schedule, leg, foothold, 0.0) for foothold in footholds]
        assert max(ramps_s) > 2.0 * min(ramps_s)


def test_first_and_last_stance_reach_to_the_ends_of_what_is_known() -> None:
    schedule = gait_schedule("trot", 5.0)
    swings = schedule.swings[0]
    assert ramp_duration(CONFIG, schedule, 0, 0, 0.0) == pytest.approx(0.02 * swings[0].start_s)
    assert ramp_duration(CONFIG, schedule, 0, 0, -0.3) == pytest.approx(0.02 * (swings[0].start_s + 0.3))
    rest_s = schedule.duration_s - swings[-1].end_s
    assert ramp_duration(CONFIG, schedule, 0, len(swings), 0.0) == pytest.approx(0.02 * rest_s)


def test_standing_leg_has_no_ramp() -> None:
    assert ramp_duration(CONFIG, standing_schedule(), 0, 0, 0.0) == 0.0
