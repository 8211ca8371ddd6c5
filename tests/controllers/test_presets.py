"""Every controller in conf/ composes, builds for every robot and stands."""

import numpy as np
import pytest
from controller_cases import robot_named, standing_schedule, uniform_plan, with_loads
from preset_cases import LEVELLED, PRESETS, dynamics_residual, near_rest, preset, resolved

from quadlab.controllers.tracking_controller import build_controller
from quadlab.robots.catalogue import robot_names

presets = pytest.mark.parametrize("name", PRESETS)


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
    np.testing.assert_allclose(telemetry.contact_forces_desired.sum(axis=0), [0.0, 0.0, weight], atol=0.01 * weight)
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
