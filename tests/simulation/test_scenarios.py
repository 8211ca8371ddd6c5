"""Scenarios that come with quadlab, and initial states drawn from a seed."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from pydantic import ValidationError

from quadlab.robots.catalogue import robot_config, robot_names
from quadlab.robots.model import RobotModel, load_robot
from quadlab.simulation.push import PushConfig
from quadlab.simulation.scenario import InitialPerturbationConfig, ScenarioConfig, initial_state
from quadlab.simulation.simulator import SimulationConfig, Simulator

CONF = Path(__file__).parents[2] / "conf"
PERTURBED = InitialPerturbationConfig(yaw_deg=20.0, pitch_deg=4.0, roll_deg=4.0, joint_rad=0.1, velocity_mps=0.3)


@pytest.fixture(params=robot_names())
def robot(request: pytest.FixtureRequest) -> RobotModel:
    return load_robot(robot_config(request.param))


@pytest.mark.parametrize("path", sorted((CONF / "scenario").glob("*.yaml")), ids=lambda path: path.stem)
def test_every_scenario_runs(path: Path) -> None:
    scenario = ScenarioConfig.model_validate(yaml.safe_load(path.read_text()))
    assert scenario.name == path.stem
    config = SimulationConfig.model_validate(yaml.safe_load((CONF / "simulation" / "standard.yaml").read_text()))
    state = Simulator(load_robot(robot_config("anymal_b")), scenario, config, seed=1).reset()
    assert state.is_finite()


def test_equal_seeds_draw_equal_states(robot: RobotModel) -> None:
    first, second, other = (initial_state(robot, PERTURBED, seed) for seed in (7, 7, 8))
    np.testing.assert_array_equal(first.joint_positions, second.joint_positions)
    np.testing.assert_array_equal(first.quat_wxyz, second.quat_wxyz)
    np.testing.assert_array_equal(first.linear_velocity_base_in_world, second.linear_velocity_base_in_world)
    assert np.all(first.joint_positions != other.joint_positions)


def test_perturbed_robots_touch_the_ground_and_do_not_sink_in(robot: RobotModel) -> None:
    nominal = robot.nominal_state()
    for seed in range(20):
        state = initial_state(robot, PERTURBED, seed)
        heights = robot.kinematics(state).foot_positions[:, 2]
        assert heights.min() == pytest.approx(0.0, abs=1e-9)
        offset = np.abs(state.joint_positions - nominal.joint_positions)
        assert 0.0 < offset.max() <= 0.1 + 1e-12
        assert 0.0 < np.abs(state.linear_velocity_base_in_world).max() <= 0.3


def test_zero_ranges_give_the_nominal_stance(robot: RobotModel) -> None:
    zero = InitialPerturbationConfig(yaw_deg=0.0, pitch_deg=0.0, roll_deg=0.0, joint_rad=0.0, velocity_mps=0.0)
    state, nominal = initial_state(robot, zero, 3), robot.nominal_state()
    np.testing.assert_allclose(state.position_base_in_world, nominal.position_base_in_world, atol=1e-12)
    np.testing.assert_array_equal(state.joint_positions, nominal.joint_positions)
    np.testing.assert_array_equal(state.quat_wxyz, nominal.quat_wxyz)


def test_a_push_needs_a_direction() -> None:
    with pytest.raises(ValidationError, match="expected a direction of non-zero length"):
        PushConfig(body="base", direction=(0.0, 0.0, 0.0), force_n=1.0, start_s=0.0, duration_s=0.1)


def test_a_push_has_its_magnitude_along_its_direction() -> None:
    push = PushConfig(body="base", direction=(0.0, 3.0, 4.0), force_n=50.0, start_s=0.0, duration_s=0.1)
    np.testing.assert_allclose(push.force, [0.0, 30.0, 40.0])
