"""How far the estimate was from the truth in a trial."""

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from quadlab.controllers.telemetry import ControlTelemetry
from quadlab.estimation.estimate import Estimate
from quadlab.geometry.rotations import Array
from quadlab.robots.state import RobotState
from quadlab.trials.metrics import rms

_VELOCITY, _QUAT = slice(3, 6), slice(6, 10)


@dataclass
class EstimationMetrics:
    """Collects errors of the estimate tick by tick; there are none if the controller was given the truth.

    Position and heading are not observable by legs and inertial unit: their errors are called drift and grow with
    time. Velocity (in base axes) and roll and pitch are observable: their errors stay small.
    """

    _true_states: list[Array] = field(default_factory=list)
    _believed_states: list[Array] = field(default_factory=list)
    _believed_com_errors: list[Array] = field(default_factory=list)
    _believed_height_errors: list[float] = field(default_factory=list)
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
        self._true_states.append(_base_of(true_state))
        self._believed_states.append(_base_of(estimate.state))
        self._believed_com_errors.append(telemetry.com_position - telemetry.com_position_reference)
        believed_height = float(estimate.state.position_base_in_world[2])
        self._believed_height_errors.append(believed_height - telemetry.base_height_reference)
        self._updates_us.append(estimate.report.update_us)
        self._innovation_squared += estimate.report.innovation_squared
        self._innovation_size += estimate.report.innovation_size
        self._outliers = estimate.report.outliers

    def summary(self) -> dict[str, float | int | None]:
        """Return the metrics by their names in ``TrialResult``; empty if the controller was given the truth."""
        if not self._true_states:
            return {}
        true, believed = np.array(self._true_states), np.array(self._believed_states)
        true_turn, believed_turn = (
            Rotation.from_quat(states[:, _QUAT], scalar_first=True) for states in (true, believed)
        )
        turns = np.degrees((believed_turn * true_turn.inv()).as_rotvec())
        tilts = np.hypot(turns[:, 0], turns[:, 1])
        velocity_errors = believed_turn.inv().apply(believed[:, _VELOCITY]) - true_turn.inv().apply(true[:, _VELOCITY])
        com_errors = np.linalg.norm(np.array(self._believed_com_errors)[:, :2], axis=1)
        return {
            "com_error_believed_rms_mm": 1e3 * rms(com_errors),
            "com_error_believed_max_mm": 1e3 * float(com_errors.max()),
            "base_height_believed_rms_mm": 1e3 * rms(np.array(self._believed_height_errors)),
            "estimate_position_drift_mm": 1e3 * math.dist(believed[-1, :3], true[-1, :3]),
            "estimate_yaw_drift_deg": abs(float(turns[-1, 2])),
            "estimate_roll_pitch_rms_deg": rms(tilts),
            "estimate_roll_pitch_max_deg": float(tilts.max()),
            "estimate_velocity_rms_mps": rms(np.linalg.norm(velocity_errors, axis=1)),
            "estimate_innovation_ratio": self._innovation_squared / max(self._innovation_size, 1),
            "estimate_outliers": self._outliers,
            "estimate_update_median_us": float(np.median(self._updates_us)),
        }


def _base_of(state: RobotState) -> Array:
    """Return position, velocity and quaternion of the base in world components, (10,)."""
    return np.concatenate([state.position_base_in_world, state.linear_velocity_base_in_world, state.quat_wxyz])
