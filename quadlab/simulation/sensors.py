"""The simulated sensors: true values of the physics with the errors of real devices."""

from collections import deque
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.robots.legs import JOINT_COUNT, LEG_COUNT
from quadlab.robots.sensing import SensorConfig, SensorReading
from quadlab.robots.state import JointCommand, RobotState
from quadlab.simulation.conventions import ACCELEROMETER, GYROSCOPE, PhysicsArrays

_SENSOR_STREAM = 1
"""Key of the sensors' random numbers; those of the initial state are drawn from the bare seed."""

_GYRO_WALK, _ACCELEROMETER_WALK, _GYRO, _ACCELEROMETER = (slice(3 * i, 3 * i + 3) for i in range(4))
_POSITIONS, _VELOCITIES, _TORQUES, _FORCES = (slice(12 * i, 12 * i + 12) for i in range(1, 5))
"""Where the noise of each sensor stands among the random numbers of a reading, (60,)."""


@dataclass(frozen=True)
class ImuSample:
    """Mean rates of one control period, without errors.

    Attributes:
        gyro: angular velocity in base axes, (3,) in [rad/s].
        accelerometer: specific force in base axes, (3,) in [m/s^2].
    """

    gyro: Array
    accelerometer: Array


@dataclass
class ImuIntegrator:
    """Averages the inertial sensors over the physics steps of a control period, as real units do on board.

    One sample of a control period would miss the impacts in between, and their velocity change with them.
    """

    gyroscope: slice
    accelerometer: slice
    _gyro: Array = field(default_factory=lambda: np.zeros(3))
    _force: Array = field(default_factory=lambda: np.zeros(3))
    _steps: int = 0

    @classmethod
    def of(cls, model: Any) -> "ImuIntegrator":
        """Look up the sensors of the compiled ``model``."""
        gyro, force = (int(model.sensor(name).adr[0]) for name in (GYROSCOPE, ACCELEROMETER))
        return cls(slice(gyro, gyro + 3), slice(force, force + 3))

    def restart(self) -> None:
        """Begin a new control period."""
        self._gyro, self._force, self._steps = np.zeros(3), np.zeros(3), 0

    def add(self, data: PhysicsArrays) -> None:
        """Take in the physics step that ``data`` just made.

        The step moves the base with the velocity at its end and the acceleration at its start.
        """
        self._gyro += data.qvel[3:6]
        self._force += data.sensordata[self.accelerometer]
        self._steps += 1

    def sample(self, data: PhysicsArrays) -> ImuSample:
        """Return the means since ``restart``; the present values if there was no step."""
        if self._steps == 0:
            return ImuSample(data.sensordata[self.gyroscope].copy(), data.sensordata[self.accelerometer].copy())
        return ImuSample(self._gyro / self._steps, self._force / self._steps)


class Sensors:
    """Adds the errors of ``config`` to true values; equal seeds give equal errors.

    Args:
        config: errors of the sensors, None for sensors without errors.
        period_s: time between readings in [s].
        seed: of the trial.
    """

    def __init__(self, config: SensorConfig | None, period_s: float, seed: int) -> None:
        self.config = config
        self._random = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(_SENSOR_STREAM,)))
        self._delayed: deque[SensorReading] = deque()
        if config is None:
            return
        self.gyro_bias = config.imu.gyro_bias_radps * self._random.standard_normal(3)
        self.accelerometer_bias = config.imu.accelerometer_bias_mps2 * self._random.standard_normal(3)
        self.joint_offsets = config.joints.position_offset_rad * self._random.standard_normal(JOINT_COUNT)
        self._deviations = _deviations(config, period_s)

    def read(self, state: RobotState, imu: ImuSample, command: JointCommand) -> SensorReading:
        """Return what the sensors say at the end of a control period.

        Args:
            state: true state.
            imu: mean rates of the period.
            command: torques that acted in the period.
        """
        true = SensorReading(
            time_s=state.time_s,
            gyro=imu.gyro,
            accelerometer=imu.accelerometer,
            joint_positions=state.joint_positions,
            joint_velocities=state.joint_velocities,
            joint_torques=command.torques,
            foot_forces_in_base=state.foot_forces_in_world @ state.rotation_base_to_world,
        )
        return true if self.config is None else self._late(self._disturbed(true), self.config)

    def _disturbed(self, true: SensorReading) -> SensorReading:
        """Add noise, biases and offsets; the biases of the inertial unit walk on by one period."""
        noise = self._deviations * self._random.standard_normal(len(self._deviations))
        self.gyro_bias = self.gyro_bias + noise[_GYRO_WALK]
        self.accelerometer_bias = self.accelerometer_bias + noise[_ACCELEROMETER_WALK]
        return SensorReading(
            time_s=true.time_s,
            gyro=true.gyro + self.gyro_bias + noise[_GYRO],
            accelerometer=true.accelerometer + self.accelerometer_bias + noise[_ACCELEROMETER],
            joint_positions=true.joint_positions + self.joint_offsets + noise[_POSITIONS],
            joint_velocities=true.joint_velocities + noise[_VELOCITIES],
            joint_torques=true.joint_torques + noise[_TORQUES],
            foot_forces_in_base=true.foot_forces_in_base + noise[_FORCES].reshape(LEG_COUNT, 3),
        )

    def _late(self, reading: SensorReading, config: SensorConfig) -> SensorReading:
        """Return the reading of ``latency_ticks`` periods ago, with the time of its arrival; at first the first one."""
        self._delayed.append(reading)
        if len(self._delayed) > config.latency_ticks + 1:
            self._delayed.popleft()
        if self._delayed[0] is reading:
            return reading
        return replace(self._delayed[0], time_s=reading.time_s)


def _deviations(config: SensorConfig, period_s: float) -> Array:
    """Return the standard deviations of the random numbers of a reading, (60,).

    A mean over T of noise with density d has the deviation d / sqrt(T); a bias walks by d sqrt(T) in T.
    """
    imu, joints, root_s = config.imu, config.joints, np.sqrt(period_s)
    of_blocks = (
        (_GYRO_WALK, imu.gyro_bias_walk_radps2_per_sqrt_hz * root_s),
        (_ACCELEROMETER_WALK, imu.accelerometer_bias_walk_mps3_per_sqrt_hz * root_s),
        (_GYRO, imu.gyro_noise_radps_per_sqrt_hz / root_s),
        (_ACCELEROMETER, imu.accelerometer_noise_mps2_per_sqrt_hz / root_s),
        (_POSITIONS, joints.position_noise_rad),
        (_VELOCITIES, joints.velocity_noise_radps),
        (_TORQUES, joints.torque_noise_nm),
        (_FORCES, config.foot_force_noise_n),
    )
    deviations = np.empty(_FORCES.stop)
    for block, deviation in of_blocks:
        deviations[block] = deviation
    return deviations
