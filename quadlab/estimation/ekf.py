"""An extended Kalman filter that fuses inertial unit, leg kinematics and contacts (Bloesch 2012).

Roll, pitch, velocity and the biases are observable; position and heading are not and drift (Bloesch 2012, IV).
"""

import time
from typing import Literal

import numpy as np

from quadlab.configuration import NonNegative, StrictModel, register
from quadlab.constants import GRAVITY
from quadlab.estimation.contact_detection import ContactDetectionConfig, ContactDetector
from quadlab.estimation.correction import Correction, LegMeasurementConfig, correct
from quadlab.estimation.error_state import (
    ACCELEROMETER_BIAS,
    ERROR_SIZE,
    FEET,
    GYRO_BIAS,
    ORIENTATION,
    POSITION,
    VELOCITY,
    FilterState,
    box_plus,
    foot_block,
    standard_deviations,
)
from quadlab.estimation.estimate import Estimate, FilterReport, ReadSensors
from quadlab.estimation.leg_kinematics import LegKinematics, LegModel
from quadlab.estimation.prediction import ProcessNoiseConfig, predict
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array, matrix_to_quat, skew
from quadlab.robots.legs import LEG_COUNT
from quadlab.robots.model import RobotModel
from quadlab.robots.sensing import ContactSensing, SensorConfig, SensorReading
from quadlab.robots.state import RobotState

_INITIAL_ERROR_STREAM = 2
"""Key of the random numbers of the first error; those of the sensors have another."""

_KNOWN = 1e-6
"""Standard deviation in [m] and [rad] of position and heading at the start, where they define the world frame."""

_UNKNOWN_FOOT_M = 1.0


class InitialUncertaintyConfig(StrictModel):
    """Standard deviations at the start; tilt and velocity are wrong by a draw from them, the biases begin at zero.

    Attributes:
        tilt_rad: of roll and pitch in [rad].
        velocity_mps: of each component in [m/s].
        gyro_bias_radps, accelerometer_bias_mps2: of each component in [rad/s] and [m/s^2].
    """

    tilt_rad: NonNegative
    velocity_mps: NonNegative
    gyro_bias_radps: NonNegative
    accelerometer_bias_mps2: NonNegative


@register("estimator", "ekf")
class ExtendedKalmanFilter:
    """Predicts with the inertial unit, corrects with the feet that stand.

    A foot that has slipped does not fit what the others and the inertial unit say, and is refused; if none fits for a
    while, it is the prediction that is wrong, and all are used. From the first update on a foot's force is
    zero unless contact is detected.

    Attributes:
        sensors: errors of the sensors that it is given.
        state: what the filter believes.
        covariance: of its error, (27, 27).
    """

    class Config(StrictModel):
        """The sensors as they are, and what the filter reckons with.

        Attributes:
            contact_sensing: where the forces under the feet come from.
            sensors: errors of the simulated sensors.
            process_noise, leg_measurement, initial: what the filter reckons with.
            contact: contact detection.
        """

        kind: Literal["ekf"]
        contact_sensing: ContactSensing
        sensors: SensorConfig
        process_noise: ProcessNoiseConfig
        leg_measurement: LegMeasurementConfig
        initial: InitialUncertaintyConfig
        contact: ContactDetectionConfig

    def __init__(self, config: Config, robot: RobotModel, period_s: float, seed: int) -> None:
        self.config = config
        self.sensors = config.sensors
        self.covariance: Array
        self.state: FilterState
        self._period_s = period_s
        self._seed = seed
        self._foot_radius = robot.foot_radius
        self._legs = LegModel(robot)
        self._detector = ContactDetector(config.contact, robot.mass * GRAVITY, period_s)
        self._standing = np.zeros(LEG_COUNT, dtype=bool)
        self._refusals = np.zeros(LEG_COUNT, dtype=int)
        self._outliers = 0
        self._joint_velocities = np.zeros(3 * LEG_COUNT)
        self._foot_spins = np.zeros((LEG_COUNT, 3))

    def start(self, read_sensors: ReadSensors, true_state: RobotState) -> Estimate:
        """Begin at ``true_state``, whose position and heading define the world, with errors in tilt and velocity."""
        reading = read_sensors()
        legs = self._legs.kinematics(reading.joint_positions, reading.joint_velocities)
        rotation, position = true_state.rotation_base_to_world, true_state.position_base_in_world
        truth = FilterState.of(
            position=position,
            velocity=true_state.linear_velocity_base_in_world,
            rotation=rotation,
            feet=position + legs.foot_centers @ rotation.T,
            accelerometer_bias=np.zeros(3),
            gyro_bias=np.zeros(3),
        )
        random = np.random.default_rng(np.random.SeedSequence(self._seed, spawn_key=(_INITIAL_ERROR_STREAM,)))
        error = np.zeros(ERROR_SIZE)
        error[ORIENTATION][:2] = self.config.initial.tilt_rad * random.standard_normal(2)
        error[VELOCITY] = self.config.initial.velocity_mps * random.standard_normal(3)
        # Base and feet stay where they are: dr and dp_i make up for turning about the world's origin.
        tilted = box_plus(truth, error)
        error[POSITION] = truth.position - tilted.position
        error[FEET] = (truth.feet - tilted.feet).ravel()
        self.state = box_plus(truth, error)
        self.covariance = _initial_covariance(self.config.initial, self.state)
        self._remember(reading, legs)
        no_feet = np.zeros(LEG_COUNT, dtype=bool)
        correction = Correction(self.state, self.covariance, no_feet, no_feet, self._refusals, 0.0)
        report = self._report(correction, 0.0)
        return Estimate(self._robot_state(reading, reading.foot_forces_in_base @ self.state.rotation.T), report)

    def update(self, read_sensors: ReadSensors, true_state: RobotState) -> Estimate:
        """Return the estimate one control period after the last; ``true_state`` is not looked at."""
        reading = read_sensors()
        began = time.perf_counter()
        legs = self._legs.kinematics(reading.joint_positions, reading.joint_velocities)
        self._predict(reading, legs)
        forces = self._foot_forces(reading, legs)
        landed = self._detect(forces)
        correction = self._correct(legs, landed)
        self._remember(reading, legs)
        update_us = 1e6 * (time.perf_counter() - began)
        felt = np.where(self._detector.touches[:, None], forces, 0.0)
        return Estimate(self._robot_state(reading, felt), self._report(correction, update_us))

    def _predict(self, reading: SensorReading, legs: LegKinematics) -> None:
        self.state, self.covariance = predict(
            self.state,
            self.covariance,
            reading,
            0.5 * (self._foot_spins + legs.foot_spins),
            self._standing,
            self.config.process_noise,
            self._period_s,
            self._foot_radius,
        )

    def _foot_forces(self, reading: SensorReading, legs: LegKinematics) -> Array:
        """Return the forces under the feet in world components, (4, 3) in [N]."""
        forces = reading.foot_forces_in_base
        if self.config.contact_sensing is ContactSensing.TORQUES:
            accelerations = (reading.joint_velocities - self._joint_velocities) / self._period_s
            forces = self._legs.foot_forces(reading, legs, accelerations)
        in_world: Array = forces @ self.state.rotation.T
        return in_world

    def _detect(self, forces: Array) -> BoolArray:
        """Update which feet stand; return those that have just begun to."""
        before = self._standing
        self._standing = self._detector.update(forces[:, 2])
        landed: BoolArray = self._standing & ~before
        return landed

    def _correct(self, legs: LegKinematics, landed: BoolArray) -> Correction:
        correction = correct(
            self.state,
            self.covariance,
            legs,
            self._standing,
            landed,
            self._refusals,
            self.config.leg_measurement,
        )
        self.state, self.covariance, self._refusals = correction.state, correction.covariance, correction.refusals
        self._outliers += int(np.count_nonzero(correction.refused))
        return correction

    def _remember(self, reading: SensorReading, legs: LegKinematics) -> None:
        self._joint_velocities, self._foot_spins = reading.joint_velocities, legs.foot_spins

    def _robot_state(self, reading: SensorReading, forces: Array) -> RobotState:
        return RobotState(
            time_s=reading.time_s,
            position_base_in_world=self.state.position,
            quat_wxyz=matrix_to_quat(self.state.rotation),
            joint_positions=reading.joint_positions,
            linear_velocity_base_in_world=self.state.velocity,
            angular_velocity_base_in_base=reading.gyro - self.state.gyro_bias,
            joint_velocities=reading.joint_velocities,
            foot_forces_in_world=forces,
        )

    def _report(self, correction: Correction, update_us: float) -> FilterReport:
        deviations = standard_deviations(self.state, self.covariance)
        return FilterReport(
            accelerometer_bias=self.state.accelerometer_bias,
            gyro_bias=self.state.gyro_bias,
            contacts=self._standing,
            used=correction.used,
            position_std=deviations[0],
            velocity_std=deviations[1],
            orientation_std=deviations[2],
            innovation_squared=correction.innovation_squared,
            innovation_size=3 * int(np.count_nonzero(correction.used)),
            outliers=self._outliers,
            update_us=update_us,
        )


def _initial_covariance(config: InitialUncertaintyConfig, state: FilterState) -> Array:
    """Return the covariance of the error at the start, (27, 27).

    What is known are the base's place and, roughly, the feet's. Their errors dr = -dtheta x r + (r - r^) and likewise
    dp_i depend on that of the tilt: without this correlation estimates would depend on where the world has its origin.
    """
    deviations = np.full(ERROR_SIZE, _UNKNOWN_FOOT_M)
    deviations[POSITION] = _KNOWN
    deviations[VELOCITY] = max(config.velocity_mps, _KNOWN)
    deviations[ORIENTATION] = [*np.maximum(np.full(2, config.tilt_rad), _KNOWN), _KNOWN]
    deviations[ACCELEROMETER_BIAS] = max(config.accelerometer_bias_mps2, _KNOWN)
    deviations[GYRO_BIAS] = max(config.gyro_bias_radps, _KNOWN)
    levers = np.eye(ERROR_SIZE)
    levers[POSITION, ORIENTATION] = skew(state.position)
    for leg, foot in enumerate(state.feet):
        levers[foot_block(leg), ORIENTATION] = skew(foot)
    return np.asarray(levers @ np.diag(deviations**2) @ levers.T)
