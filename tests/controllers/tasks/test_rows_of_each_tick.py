"""Rows follow the tick: nothing of an earlier one is left, though tasks keep their arrays."""

from dataclasses import replace

import numpy as np
import pytest
from controller_cases import STANCES, robot_named
from preset_cases import LEVELLED, near_rest, preset

from quadlab.controllers.limits.torque_limits import TorqueLimits
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.task_levels import build_task
from quadlab.robots.kinematics import Kinematics


def ticks() -> list[tuple[Kinematics, ControlReference]]:
    robots = [robot_named(name) for name in ("anymal_b", "solo12")]
    return [near_rest(robot, stance, seed) for stance in STANCES for robot in robots for seed in range(2)]


@pytest.mark.parametrize("name", LEVELLED)
def test_a_task_that_has_seen_other_ticks_gives_the_same_rows_as_a_new_one(name: str) -> None:
    for config in [task for level in preset(name).levels for task in level.tasks]:
        used = build_task(config)
        for tick in ticks():
            rows, fresh = used.rows(*tick), build_task(config).rows(*tick)
            assert rows.variable is fresh.variable
            for array, expected in zip(rows[1:], fresh[1:], strict=True):
                np.testing.assert_array_equal(array, expected)


def test_torque_limits_that_change_in_place_are_seen() -> None:
    kinematics, exact = near_rest(robot_named("anymal_b"), [0, 1, 2, 3])
    reference = replace(exact, torque_limits=exact.torque_limits.copy())
    task = TorqueLimits(TorqueLimits.Config(task="torque_limits", share=0.5))
    before = task.rows(kinematics, reference).upper.copy()
    reference.torque_limits[3] *= 2.0
    rows = task.rows(kinematics, reference)
    np.testing.assert_array_equal(rows.upper, 0.5 * reference.torque_limits)
    np.testing.assert_array_equal(rows.lower, -rows.upper)
    assert rows.upper[3] == 2.0 * before[3]
