"""Every controller in conf/ composes, builds for every robot and stands."""

from dataclasses import replace

import numpy as np
import pytest
from controller_cases import integrated, robot_named, standing_schedule, uniform_plan, with_loads
from preset_cases import FREE_HEIGHT, LEVELLED, PRESETS, dynamics_residual, near_rest, preset, resolved

from quadlab.controllers.reduced_dynamics import reduce_dynamics
from quadlab.controllers.tracking_controller import build_controller
from quadlab.geometry.rotations import Array
from quadlab.robots.catalogue import robot_names
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState

STANDING = [0, 1, 2, 3]
presets = pytest.mark.parametrize("name", PRESETS)


def upward_acceleration(robot: RobotModel, state: RobotState, torques: Array) -> float:
    """Of the centre of mass of a standing robot in [m/s^2]."""
    kinematics = robot.kinematics(state)
    acceleration = reduce_dynamics(kinematics, STANDING).accelerations(torques)
    return float((kinematics.com_jacobian @ acceleration + kinematics.com_bias)[2])


@presets
@pytest.mark.parametrize("robot_name", robot_names())
def test_every_controller_stands_on_every_robot(name: str, robot_name: str) -> None:
    robot = robot_named(robot_name)
    controller = build_controller(preset(name), robot)
    state = with_loads(robot, robot.nominal_state())
    controller.start(uniform_plan(robot, standing_schedule()), state)
    command, telemetry = controller.tick(state)
    weight = robot.mass * 9.81
    assert telemetry.fallbacks == 0
    assert tuple(telemetry.level_residuals) == controller.level_names
    assert np.all(np.abs(command.torques) <= robot.torque_limits)
    force = telemetry.contact_forces_desired.sum(axis=0)
    np.testing.assert_allclose(force[:2], 0.0, atol=0.01 * weight)
    rise = upward_acceleration(robot, state, command.torques) if name == FREE_HEIGHT else 0.0
    np.testing.assert_allclose(force[2], weight + robot.mass * rise, rtol=0.01)
    assert (command.drive is None) == (preset(name).joint_pd is None)


@presets
def test_configuration_survives_a_round_trip(name: str) -> None:
    config = preset(name)
    assert type(config).model_validate(config.model_dump()) == config
    assert config.name == name


@pytest.mark.parametrize("name", LEVELLED)
@pytest.mark.parametrize("stance", [[0, 1, 2, 3], [0, 1, 3], [1, 2]], ids=str)
def test_what_is_expected_obeys_the_equations_of_motion(name: str, stance: list[int]) -> None:
    robot = robot_named("anymal_b")
    kinematics, reference = near_rest(robot, stance)
    resolution = resolved(preset(name), kinematics, reference)
    assert resolution.solved
    np.testing.assert_allclose(dynamics_residual(kinematics, resolution), 0.0, atol=1e-8)
    contact = kinematics.contact_jacobians[stance] @ resolution.accelerations + kinematics.contact_bias[stance]
    np.testing.assert_allclose(contact, 0.0, atol=1e-8)
    in_air = [leg for leg in range(4) if leg not in stance]
    np.testing.assert_array_equal(resolution.contact_forces[in_air], 0.0)


@pytest.mark.parametrize("name", LEVELLED)
def test_same_tick_gives_same_bits(name: str) -> None:
    robot = robot_named("anymal_b")
    first, second = (resolved(preset(name), *near_rest(robot, [0, 1, 3], seed=4)) for _ in range(2))
    assert first.torques.tobytes() == second.torques.tobytes()
    assert first.accelerations.tobytes() == second.accelerations.tobytes()


def test_table_one_of_the_paper_is_in_order() -> None:
    names = [level.name for level in preset("bellicoso2016").levels]
    tasks = [task.task for level in preset("bellicoso2016").levels for task in level.tasks]
    assert len(names) == 9, "the first two of eleven are eliminated"
    assert tasks == [
        "torque_limits",
        "friction_cone",
        "com_position",
        "swing_feet",
        "limb_extension",
        "base_yaw",
        "base_height",
        "base_roll_pitch",
        "contact_force_minimisation",
    ]


def test_only_the_height_is_another_one_where_it_emerges() -> None:
    given, free = preset("bellicoso2016"), preset(FREE_HEIGHT)
    others = [(a, b) for a, b in zip(given.levels, free.levels, strict=True) if a != b]
    assert [(a.name, b.name) for a, b in others] == [("height", "height")]
    assert [task.task for task in others[0][1].tasks] == ["manipulability_height"]
    same = {"name": given.name, "levels": given.levels}
    assert free.model_copy(update=same) == given


def settled_height(knee: float, thigh: float) -> float:
    """Height of the base in [m] after 2 s of ideal motion on standing feet that do not slip."""
    robot = robot_named("anymal_b")
    joints = robot.nominal_joint_positions.copy()
    joints[1::3] = thigh * np.sign(joints[1::3])
    joints[2::3] = knee * np.sign(joints[2::3])
    start = replace(robot.nominal_state(), joint_positions=joints)
    lowest = robot.kinematics(start).foot_positions[:, 2].min()
    state = replace(start, position_base_in_world=start.position_base_in_world - [0.0, 0.0, lowest])
    controller = build_controller(preset(FREE_HEIGHT), robot)
    controller.start(uniform_plan(robot, standing_schedule()), with_loads(robot, state))
    for _ in range(round(2.0 / controller.period_s)):
        command, _ = controller.tick(with_loads(robot, state))
        acceleration = reduce_dynamics(robot.kinematics(state), STANDING).accelerations(command.torques)
        state = integrated(robot, state, acceleration, controller.period_s)
    assert abs(state.linear_velocity_base_in_world[2]) < 2e-3
    return float(state.position_base_in_world[2])


def test_emerging_height_is_the_same_from_above_and_from_below() -> None:
    """Between knees that are too straight (0.527 m) and too bent (0.452 m)."""
    above, below = settled_height(0.75, 0.557), settled_height(1.2, 0.815)
    assert above == pytest.approx(below, abs=5e-3)
    assert 0.49 < below < 0.52
