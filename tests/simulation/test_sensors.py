"""Simulated sensors measure the physics, err as configured, and never change the trial."""

import numpy as np
import pytest
from simulation_cases import exact_simulation

from quadlab.geometry.rotations import rotation_log
from quadlab.robots.catalogue import robot_config
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.sensing import ImuConfig, JointSensorConfig, SensorConfig
from quadlab.robots.state import JointCommand, RobotState
from quadlab.simulation.scenario import InitialPerturbationConfig, ScenarioConfig
from quadlab.simulation.sensors import ImuSample, Sensors
from quadlab.simulation.simulator import Simulator

PERIOD = 0.0025  # [s]
GRAVITY = 9.81  # [m/s^2]
NO_TORQUE = JointCommand(np.zeros(12))


@pytest.fixture(scope="module")
def robot() -> RobotModel:
    return load_robot(robot_config("anymal_b"))


def simulator(robot: RobotModel) -> Simulator:
    perturbation = InitialPerturbationConfig(yaw_deg=9.0, pitch_deg=3.0, roll_deg=3.0, joint_rad=0.0, velocity_mps=0.2)
    scenario = ScenarioConfig(name="test", friction=0.8, terrain=(), pushes=(), initial_perturbation=perturbation)
    return Simulator(robot, scenario, exact_simulation(0.00125), seed=1)


def errors(**changes: float) -> SensorConfig:
    imu = dict.fromkeys(ImuConfig.model_fields, 0.0) | {k: v for k, v in changes.items() if k in ImuConfig.model_fields}
    joints = dict.fromkeys(JointSensorConfig.model_fields, 0.0) | {
        k: v for k, v in changes.items() if k in JointSensorConfig.model_fields
    }
    return SensorConfig(
        imu=ImuConfig.model_validate(imu),
        joints=JointSensorConfig.model_validate(joints),
        foot_force_noise_n=changes.get("foot_force_noise_n", 0.0),
        latency_ticks=int(changes.get("latency_ticks", 0)),
    )


def still() -> ImuSample:
    return ImuSample(np.zeros(3), np.array([0.0, 0.0, GRAVITY]))


def test_integrated_rates_are_the_changes_of_velocity_and_attitude(robot: RobotModel) -> None:
    """The robot falls onto the ground and its legs give way: impacts included, nothing is lost between readings."""
    trial = simulator(robot)
    state = trial.read()
    for _ in range(200):
        trial.advance(NO_TORQUE, PERIOD)
        after, imu = trial.read(), trial.imu()
        middle = state.rotation_base_to_world
        change = middle @ imu.accelerometer * PERIOD - np.array([0.0, 0.0, GRAVITY * PERIOD])
        true_change = after.linear_velocity_base_in_world - state.linear_velocity_base_in_world
        turn = rotation_log(state.rotation_base_to_world.T @ after.rotation_base_to_world)
        turned = np.linalg.norm(turn) * np.linalg.norm(imu.accelerometer)
        lost = float(0.01 * np.linalg.norm(true_change) + PERIOD * turned)
        np.testing.assert_allclose(change, true_change, atol=lost + 1e-6)
        np.testing.assert_allclose(imu.gyro * PERIOD, turn, atol=1e-5)
        state = after


def test_unit_at_rest_feels_what_holds_it_up(robot: RobotModel) -> None:
    trial = simulator(robot)
    trial.advance(NO_TORQUE, 4.0)
    trial.advance(NO_TORQUE, PERIOD)
    up = trial.read().rotation_base_to_world[2]
    np.testing.assert_allclose(trial.imu().accelerometer, GRAVITY * up, atol=0.02)
    np.testing.assert_allclose(trial.imu().gyro, np.zeros(3), atol=1e-3)


def test_reading_the_sensors_changes_nothing(robot: RobotModel) -> None:
    read, unread = simulator(robot), simulator(robot)
    sensors = Sensors(errors(gyro_noise_radps_per_sqrt_hz=1.0), PERIOD, seed=0)
    for _ in range(40):
        read.advance(NO_TORQUE, PERIOD)
        unread.advance(NO_TORQUE, PERIOD)
        sensors.read(read.read(), read.imu(), NO_TORQUE)
        unread.read()
    np.testing.assert_array_equal(read.integration_state(), unread.integration_state())


def test_sensors_without_errors_say_the_truth(robot: RobotModel) -> None:
    state = robot.nominal_state()
    for config in (None, errors()):
        reading = Sensors(config, PERIOD, seed=0).read(state, still(), NO_TORQUE)
        np.testing.assert_array_equal(reading.accelerometer, still().accelerometer)
        np.testing.assert_array_equal(reading.joint_positions, state.joint_positions)


def test_noise_has_the_configured_size(robot: RobotModel) -> None:
    density, encoder = 0.01, 1e-3
    config = errors(gyro_noise_radps_per_sqrt_hz=density, position_noise_rad=encoder)
    sensors, state = Sensors(config, PERIOD, seed=0), robot.nominal_state()
    readings = [sensors.read(state, still(), NO_TORQUE) for _ in range(2000)]
    gyro = np.array([reading.gyro for reading in readings])
    assert gyro.std() == pytest.approx(density / np.sqrt(PERIOD), rel=0.05)
    joints = np.array([reading.joint_positions for reading in readings])
    assert joints.std(axis=0).mean() == pytest.approx(encoder, rel=0.05)


def test_constant_errors_are_constant_and_bias_walks_with_the_root_of_time(robot: RobotModel) -> None:
    state, walk = robot.nominal_state(), 0.1
    offsets = Sensors(errors(position_offset_rad=0.01, accelerometer_bias_mps2=0.5), PERIOD, seed=3)
    first, second = (offsets.read(state, still(), NO_TORQUE) for _ in range(2))
    np.testing.assert_array_equal(first.joint_positions, second.joint_positions)
    np.testing.assert_array_equal(first.accelerometer, second.accelerometer)
    assert np.abs(first.accelerometer - still().accelerometer).min() > 0.0
    ends = []
    for seed in range(60):
        walking = Sensors(errors(gyro_bias_walk_radps2_per_sqrt_hz=walk), PERIOD, seed)
        for _ in range(100):
            walking.read(state, still(), NO_TORQUE)
        ends.append(walking.gyro_bias)
    assert np.std(ends) == pytest.approx(walk * np.sqrt(100 * PERIOD), rel=0.15)


def test_equal_seeds_give_equal_errors(robot: RobotModel) -> None:
    state = robot.nominal_state()
    config = errors(gyro_bias_radps=0.1, foot_force_noise_n=1.0, torque_noise_nm=1.0)
    first, again, other = (Sensors(config, PERIOD, seed).read(state, still(), NO_TORQUE) for seed in (4, 4, 5))
    np.testing.assert_array_equal(first.gyro, again.gyro)
    np.testing.assert_array_equal(first.foot_forces_in_base, again.foot_forces_in_base)
    assert not np.allclose(first.joint_torques, other.joint_torques)


def test_late_readings_are_old_but_arrive_now(robot: RobotModel) -> None:
    sensors, nominal = Sensors(errors(latency_ticks=2), PERIOD, seed=0), robot.nominal_state()
    states = [
        RobotState(**{**vars(nominal), "time_s": k * PERIOD, "joint_velocities": np.full(12, k)}) for k in range(5)
    ]
    readings = [sensors.read(state, still(), NO_TORQUE) for state in states]
    assert [float(reading.joint_velocities[0]) for reading in readings] == [0.0, 0.0, 0.0, 1.0, 2.0]
    assert [reading.time_s for reading in readings] == [state.time_s for state in states]
