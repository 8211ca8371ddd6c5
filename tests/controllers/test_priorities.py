"""Priorities are data: what stands higher in the YAML is kept, what stands lower gives way."""

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Literal

import numpy as np
import pytest
from controller_cases import (
    controller_config,
    disturbed_state,
    robot_named,
    shipped,
    standing_schedule,
    uniform_plan,
    with_loads,
)
from pydantic import ValidationError

from quadlab.configuration import _REGISTRY, StrictModel
from quadlab.controllers.hierarchical import HierarchicalResolver
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.resolver import Resolution
from quadlab.controllers.task_levels import LevelConfig, build_task
from quadlab.controllers.telemetry import ControlTelemetry
from quadlab.controllers.tracking_controller import build_controller
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.model import RobotModel

TOO_WEAK = 0.05  # of the torque limits: not enough to carry either robot


def levels_in_order(*names: str, torque_share: float = 1.0) -> list[dict[str, Any]]:
    by_name = {level["name"]: level for level in shipped("controller/hierarchical.yaml")["levels"]}
    by_name["torque"]["tasks"][0]["share"] = torque_share
    return [by_name[name] for name in names]


def standing_tick(robot: RobotModel, levels: list[dict[str, Any]], seed: int) -> ControlTelemetry:
    controller = build_controller(controller_config(levels=levels), robot)
    controller.start(uniform_plan(robot, standing_schedule()), with_loads(robot, robot.nominal_state()))
    return controller.tick(with_loads(robot, disturbed_state(robot, seed, size=0.3)))[1]


@pytest.mark.parametrize("seed", range(3))
def test_higher_of_two_conflicting_levels_is_kept(robot: RobotModel, seed: int) -> None:
    torque_first = levels_in_order("torque", "friction", "torso", "forces", torque_share=TOO_WEAK)
    torso_first = levels_in_order("friction", "torso", "torque", "forces", torque_share=TOO_WEAK)
    weak, strong = standing_tick(robot, torque_first, seed), standing_tick(robot, torso_first, seed)
    assert weak.level_residuals["torque"] < 1e-7
    assert weak.level_residuals["torso"] > 1.0
    assert strong.level_residuals["torso"] < 1e-7
    assert strong.level_residuals["torque"] > 1.0
    assert np.all(np.abs(weak.torques_desired) <= TOO_WEAK * robot.torque_limits * (1 + 1e-9))
    assert np.any(np.abs(strong.torques_desired) > 1.1 * TOO_WEAK * robot.torque_limits)


def test_no_level_pays_for_a_lower_one(robot: RobotModel) -> None:
    """Adding levels at the bottom never changes the residuals above."""
    names = ("torque", "friction", "torso", "forces")
    ticks = [
        standing_tick(robot, levels_in_order(*names[:count], torque_share=TOO_WEAK), 1)
        for count in range(1, len(names) + 1)
    ]
    for fewer, more in pairwise(ticks):
        for name, residual in fewer.level_residuals.items():
            assert more.level_residuals[name] == pytest.approx(residual, abs=1e-6)


@dataclass
class Answers:
    """A resolver that asks for torques which no drive can give, and may call that solved."""

    solved: bool
    level_names = ("torque",)
    limit_names = level_names

    def resolve(self, kinematics: Kinematics, reference: ControlReference, last_torques: Array) -> Resolution:
        nonsense = np.full(12, 1e3)
        return Resolution(nonsense, np.zeros(18), np.zeros((4, 3)), {"torque": 0.0}, 500, solved=self.solved)


def test_torques_stay_and_are_counted_when_the_solver_gives_up(robot: RobotModel) -> None:
    controller = build_controller(controller_config(), robot)
    state = with_loads(robot, robot.nominal_state())
    controller.start(uniform_plan(robot, standing_schedule()), state)
    solved, telemetry = controller.tick(state)
    assert telemetry.fallbacks == 0
    controller.resolver = Answers(solved=False)
    kept, telemetry = controller.tick(with_loads(robot, disturbed_state(robot, 0)))
    np.testing.assert_array_equal(kept.torques, solved.torques)
    assert telemetry.fallbacks == 1


def test_torques_that_stay_are_within_the_limits(robot: RobotModel) -> None:
    controller = build_controller(controller_config(), robot)
    state = with_loads(robot, robot.nominal_state())
    controller.start(uniform_plan(robot, standing_schedule()), state)
    for solved in (True, False):
        controller.resolver = Answers(solved)
        command, _ = controller.tick(state)
    np.testing.assert_array_equal(command.torques, robot.torque_limits)


def test_level_names_are_reported_in_order() -> None:
    config = controller_config(levels=levels_in_order("friction", "torso", "torque"))
    controller = build_controller(config, robot_named("hyq"))
    assert controller.level_names == ("friction", "torso", "torque")


def test_every_task_of_the_shipped_levels_can_be_built() -> None:
    config = controller_config()
    assert all(hasattr(build_task(task), "rows") for level in config.levels for task in level.tasks)
    assert HierarchicalResolver.Config.model_validate(config.model_dump()) == config


@pytest.mark.parametrize("name", ["dance", {"kind": "x"}, ["com_position"], 3])
def test_unknown_task_is_named_with_the_known_ones(name: object) -> None:
    with pytest.raises(ValidationError, match=r"Input tag .* using 'task' .*'com_position'"):
        LevelConfig.model_validate({"name": "fun", "tasks": [{"task": name}]})


def test_a_task_may_be_registered_at_any_time(monkeypatch: pytest.MonkeyPatch) -> None:
    class Dance:
        class Config(StrictModel):
            task: Literal["dance"]

    monkeypatch.setitem(_REGISTRY["task"], "dance", Dance)
    (task,) = LevelConfig.model_validate({"name": "fun", "tasks": [{"task": "dance"}]}).tasks
    assert isinstance(task, Dance.Config)


def test_level_names_must_differ() -> None:
    twice = levels_in_order("torso", "torso")
    with pytest.raises(ValidationError, match="level names must differ"):
        controller_config(levels=twice)


@pytest.mark.parametrize(
    "change",
    [
        {"task": "torque_limits", "share": 1.5},
        {"task": "friction_cone", "friction": 0.0, "minimum_normal_force_share": 0.0},
        {"task": "base_height", "proportional_per_s2": -1.0, "derivative_per_s": 0.0},
        {"task": "base_yaw", "proportional_per_s2": 1.0},
        {"task": "contact_force_minimisation", "weight": 1.0},
    ],
    ids=lambda change: str(change["task"]),
)
def test_values_out_of_range_missing_or_unknown_are_refused(change: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        LevelConfig.model_validate({"name": "level", "tasks": [change]})


def test_state_that_is_not_finite_is_counted_and_not_obeyed(robot: RobotModel) -> None:
    controller = build_controller(controller_config(), robot)
    state = with_loads(robot, robot.nominal_state())
    controller.start(uniform_plan(robot, standing_schedule()), state)
    solved, _ = controller.tick(state)
    broken = replace(state, joint_velocities=np.full(12, np.nan))
    kept, telemetry = controller.tick(broken)
    np.testing.assert_array_equal(kept.torques, solved.torques)
    assert telemetry.fallbacks == 1


@pytest.mark.parametrize(
    "changes",
    [
        {"certify": True},
        {"method": "cascade"},
        {"formulation": "accelerations_torques"},
        {"formulation": "accelerations_forces"},
        {"joint_pd": {"proportional_nm_per_rad": 400.0, "derivative_nms_per_rad": 8.0}},
    ],
    ids=str,
)
def test_tick_that_no_method_can_solve_keeps_bounded_torques_and_says_so(
    robot: RobotModel, changes: dict[str, Any]
) -> None:
    controller = build_controller(controller_config(**changes), robot)
    state = with_loads(robot, robot.nominal_state())
    controller.start(uniform_plan(robot, standing_schedule()), state)
    solved, _ = controller.tick(state)
    kept, telemetry = controller.tick(replace(state, joint_velocities=np.full(12, np.nan)))
    np.testing.assert_array_equal(kept.torques, solved.torques)
    assert np.all(np.abs(kept.torques) <= robot.torque_limits)
    assert kept.drive is None
    assert telemetry.fallbacks == 1
    assert not telemetry.contact_forces_desired.any(), "nothing is expected of an answer that is not used"
    assert any("not solved" in event for event in telemetry.events)
