"""How far the estimate was from the truth in a trial."""

import math
from dataclasses import dataclass, field

import numpy as np

from quadlab.controllers.telemetry import ControlTelemetry
from quadlab.estimation.estimate import Estimate
from quadlab.geometry.rotations import Array, rotation_log
from quadlab.robots.state import RobotState


@dataclass
class EstimationMetrics:
    """Collects errors of the estimate tick by tick; there are none if the controller was given the truth.

    Position and heading are not observable by legs and inertial unit: their errors are called drift and grow with
    time. Velocity (in base axes) and roll and pitch are observable: their errors stay small.
    """

    _drifts: list[float] = field(default_factory=list)
    _turns: list[Array] = field(default_factory=list)
    _velocity_errors: list[Array] = field(default_factory=list)
    _believed_com_errors: list[float] = field(default_factory=list)
    _updates_us: list[float] = field(default_factory=list)
    _innovation_squared: float = 0.0
    _innovation_size: int = 0
    _outliers: int = 0

    def add(self, true_state: RobotState, estimate: Estimate, telemetry: ControlTelemetry) -> None:
        """Take in one tick.

        Args:
            true_state: at its start.
            estimate: that the controller was given.
            telemetry: of the controller, as it believed.
        """
        if estimate.report is None:
            return
        true_rotation, believed = true_state.rotation_base_to_world, estimate.state
        self._drifts.append(math.dist(believed.position_base_in_world, true_state.position_base_in_world))
        self._turns.append(rotation_log(believed.rotation_base_to_world @ true_rotation.T))
        true_velocity = true_rotation.T @ true_state.linear_velocity_base_in_world
        velocity = believed.rotation_base_to_world.T @ believed.linear_velocity_base_in_world
        self._velocity_errors.append(velocity - true_velocity)
        self._believed_com_errors.append(
            math.dist(telemetry.com_position[:2], telemetry.com_position_reference[:2]),
        )
        self._updates_us.append(estimate.report.update_us)
        self._innovation_squared += estimate.report.innovation_squared
        self._innovation_size += estimate.report.innovation_size
        self._outliers = estimate.report.outliers

    def summary(self) -> dict[str, float | int | None]:
        """Return the metrics by their names in ``TrialResult``; empty if the controller was given the truth."""
        if not self._drifts:
            return {}
        turns = np.degrees(self._turns)
        tilts = np.hypot(turns[:, 0], turns[:, 1])
        velocities = np.linalg.norm(self._velocity_errors, axis=1)
        believed = np.array(self._believed_com_errors)
        return {
            "com_error_believed_rms_mm": 1e3 * _rms(believed),
            "com_error_believed_max_mm": 1e3 * float(believed.max()),
            "estimate_position_drift_mm": 1e3 * self._drifts[-1],
            "estimate_yaw_drift_deg": abs(float(turns[-1, 2])),
            "estimate_roll_pitch_rms_deg": _rms(tilts),
            "estimate_roll_pitch_max_deg": float(tilts.max()),
            "estimate_velocity_rms_mps": _rms(velocities),
            "estimate_innovation_ratio": self._innovation_squared / max(self._innovation_size, 1),
            "estimate_outliers": self._outliers,
            "estimate_update_median_us": float(np.median(self._updates_us)),
        }


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
