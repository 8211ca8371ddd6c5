"""What the controller gets to know of the simulated robot: sensors, and the estimator behind them."""

from typing import Any

import numpy as np

from quadlab.configuration import part_of
from quadlab.controllers.telemetry import ControlTelemetry
from quadlab.estimation.estimate import Estimate, Estimator
from quadlab.robots.kinematics import MotionPoints
from quadlab.robots.model import RobotModel
from quadlab.robots.sensing import SensorReading
from quadlab.robots.state import JointCommand, RobotState
from quadlab.simulation.sensors import Sensors
from quadlab.simulation.simulator import Simulator
from quadlab.trials.config import TrialConfig


class Observer:
    """Reads the sensors of a simulator and keeps the estimate; one is made for each trial."""

    def __init__(self, config: TrialConfig, robot: RobotModel, simulator: Simulator) -> None:
        period_s = 1.0 / config.controller.rate_hz
        estimator_type: Any = part_of("estimator", config.estimator)
        self._estimator: Estimator = estimator_type(config.estimator, robot, period_s, config.seed)
        self._sensors = Sensors(self._estimator.sensors, period_s, config.seed)
        self._simulator = simulator
        self._latest: Estimate | None = None

    def observe(self, true_state: RobotState) -> Estimate:
        """Return the estimate at the simulator's present state; asking again at the same time changes nothing."""
        if self._latest is not None and self._latest.state.time_s == true_state.time_s:
            return self._latest
        step = self._estimator.start if self._latest is None else self._estimator.update
        self._latest = step(lambda: self._read_sensors(true_state), true_state)
        return self._latest

    def _read_sensors(self, true_state: RobotState) -> SensorReading:
        torques = JointCommand(self._simulator.applied_torques)
        return self._sensors.read(true_state, self._simulator.imu(), torques)


def as_it_happened(
    telemetry: ControlTelemetry, estimate: Estimate, true_state: RobotState, true_points: MotionPoints
) -> ControlTelemetry:
    """Return ``telemetry`` with the true motion in place of the believed one; references stay as they were.

    The terrain plane is moved by the drift of the estimated height, since it is known relative to the robot only.
    """
    drift = estimate.state.position_base_in_world - true_state.position_base_in_world
    plane = telemetry.terrain_plane - np.array([drift[2], 0.0, 0.0])
    return telemetry._replace(
        com_position=true_points.com_position,
        com_velocity=true_points.com_velocity,
        foot_positions=true_points.foot_positions,
        foot_contact_velocities=true_points.foot_contact_velocities,
        terrain_plane=plane,
    )
