"""What a robot measures, and how well its sensors do it."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from pydantic import Field

from quadlab.configuration import NonNegative, StrictModel
from quadlab.geometry.rotations import Array


@dataclass(frozen=True)
class SensorReading:
    """One reading of all sensors; nothing in it depends on the world frame.

    The inertial unit integrates internally, as real ones do: its rates are means over the time since the last reading.

    Attributes:
        time_s: when the reading arrives, since the start of the trial, in [s].
        gyro: angular velocity of the base in base axes, (3,) in [rad/s].
        accelerometer: specific force (acceleration minus gravity) at the base origin in base axes, (3,) in [m/s^2];
            at rest on level ground it is (0, 0, +9.81).
        joint_positions: (12,) in [rad], order ``JOINT_NAMES``.
        joint_velocities: (12,) in [rad/s].
        joint_torques: asked of the drives until the reading, (12,) in [N m].
        foot_forces_in_base: force of the ground on each foot in base axes, (4, 3) in [N], order ``LEGS``.
    """

    time_s: float
    gyro: Array
    accelerometer: Array
    joint_positions: Array
    joint_velocities: Array
    joint_torques: Array
    foot_forces_in_base: Array


class ImuConfig(StrictModel):
    """Errors of the inertial unit, each axis for itself.

    Attributes:
        gyro_noise_radps_per_sqrt_hz: density of the white noise in [rad/s/sqrt(Hz)].
        gyro_bias_radps: standard deviation of the constant bias in [rad/s].
        gyro_bias_walk_radps2_per_sqrt_hz: density of the white noise that drives the bias in [rad/s^2/sqrt(Hz)].
        accelerometer_noise_mps2_per_sqrt_hz: density of the white noise in [m/s^2/sqrt(Hz)].
        accelerometer_bias_mps2: standard deviation of the constant bias in [m/s^2].
        accelerometer_bias_walk_mps3_per_sqrt_hz: density of the noise that drives the bias in [m/s^3/sqrt(Hz)].
    """

    gyro_noise_radps_per_sqrt_hz: NonNegative
    gyro_bias_radps: NonNegative
    gyro_bias_walk_radps2_per_sqrt_hz: NonNegative
    accelerometer_noise_mps2_per_sqrt_hz: NonNegative
    accelerometer_bias_mps2: NonNegative
    accelerometer_bias_walk_mps3_per_sqrt_hz: NonNegative


class JointSensorConfig(StrictModel):
    """Standard deviations of the errors of encoders and torque sensors.

    Attributes:
        position_noise_rad: white, of every reading in [rad].
        position_offset_rad: constant, from calibration, in [rad].
        velocity_noise_radps: white, of every reading in [rad/s].
        torque_noise_nm: white, of every reading in [N m].
    """

    position_noise_rad: NonNegative
    position_offset_rad: NonNegative
    velocity_noise_radps: NonNegative
    torque_noise_nm: NonNegative


class SensorConfig(StrictModel):
    """All sensors of a robot.

    Attributes:
        imu: inertial unit at the base origin.
        joints: encoders and torque sensors.
        foot_force_noise_n: standard deviation of the white noise of a foot's force sensor in [N].
        latency_ticks: how many control periods every reading is old when it arrives.
    """

    imu: ImuConfig
    joints: JointSensorConfig
    foot_force_noise_n: NonNegative
    latency_ticks: Annotated[int, Field(ge=0)]


class ContactSensing(StrEnum):
    """What the forces under the feet are taken from."""

    FORCES = "forces"
    """Force sensors in the feet."""
    TORQUES = "torques"
    """Joint torques, less what the motion of the legs takes."""
