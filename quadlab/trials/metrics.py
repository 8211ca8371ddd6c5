"""What a trial amounts to in numbers, collected tick by tick.

Errors are measured from the truth, against references that live in the world the controller believes in. If its state
is estimated, the drift of the estimate (position and heading cannot be observed) is a part of them;
``EstimationMetrics`` tells how large it is and what error the controller saw.
"""

import hashlib
import math
from dataclasses import dataclass, field

import numpy as np

from quadlab.controllers.telemetry import ControlTelemetry, LegMode
from quadlab.geometry.rotations import Array, rotation_log, rotation_zyx
from quadlab.planners.problem import GRAVITY
from quadlab.robots.legs import LEG_COUNT
from quadlab.robots.state import JointCommand, RobotState

_AT_LIMIT = 0.999  # share of the torque limit that counts as being at it


@dataclass
class TrialMetrics:
    """Collects one row of numbers a tick; ``summary`` makes the metrics of ``TrialResult`` of them.

    Attributes:
        mass: of the robot in [kg].
        torque_limits: (12,) in [N m].
        period_s: control period in [s].
    """

    mass: float
    torque_limits: Array
    period_s: float
    _com_errors: list[float] = field(default_factory=list)
    _height_errors: list[float] = field(default_factory=list)
    _tilt_errors: list[float] = field(default_factory=list)
    _torque_peaks: list[float] = field(default_factory=list)
    _ticks_us: list[float] = field(default_factory=list)
    _at_limit: int = 0
    _energy: float = 0.0
    _slip: list[float] = field(default_factory=lambda: [0.0] * LEG_COUNT)
    _slip_max: float = 0.0
    _fallbacks: int = 0
    _first: RobotState | None = None
    _last: RobotState | None = None
    _hash: "hashlib._Hash" = field(default_factory=hashlib.sha256)

    def add(self, state: RobotState, command: JointCommand, telemetry: ControlTelemetry, physics_state: Array) -> None:
        """Take in one tick.

        Args:
            state: true state at its start.
            command: torques as applied (within the limits).
            telemetry: of the controller, its measured quantities replaced by the true ones.
            physics_state: everything the simulator integrates; goes into the hash.
        """
        self._first = self._first or state
        self._last = state
        self._com_errors.append(
            math.dist(telemetry.com_position[:2], telemetry.com_position_reference[:2]),
        )
        self._height_errors.append(float(state.position_base_in_world[2]) - telemetry.base_height_reference)
        self._tilt_errors.append(_roll_pitch_error(state, telemetry))
        torques = np.abs(command.torques)
        self._torque_peaks.append(float(torques.max()))
        self._at_limit += bool((torques >= _AT_LIMIT * self.torque_limits).any())
        self._energy += float(np.abs(command.torques * state.joint_velocities).sum()) * self.period_s
        self._add_slip(state, telemetry)
        self._ticks_us.append(telemetry.tick_us)
        self._fallbacks = telemetry.fallbacks
        self._hash.update(np.ascontiguousarray(physics_state).tobytes())

    def _add_slip(self, state: RobotState, telemetry: ControlTelemetry) -> None:
        """Integrate the speed of the material point under each standing, loaded foot over its stance."""
        velocities, forces = telemetry.foot_contact_velocities.tolist(), state.foot_forces_in_world[:, 2].tolist()
        for leg, mode in enumerate(telemetry.leg_modes):
            speed = math.hypot(*velocities[leg][:2]) if forces[leg] > 0.0 else 0.0
            self._slip[leg] = self._slip[leg] + speed * self.period_s if mode is LegMode.STANCE else 0.0
        self._slip_max = max(self._slip_max, *self._slip)

    def summary(self) -> dict[str, float | int | str | None]:
        """Return the metrics by their names in ``TrialResult``; empty if there was no tick."""
        if self._first is None or self._last is None:
            return {}
        start, end = self._first.position_base_in_world, self._last.position_base_in_world
        distance = math.dist(start[:2], end[:2])
        survived = self._last.time_s + self.period_s - self._first.time_s
        weight = self.mass * GRAVITY
        return {
            "survived_s": survived,
            "distance_m": distance,
            "mean_speed_mps": distance / survived,
            "com_error_rms_mm": 1e3 * _rms(self._com_errors),
            "com_error_max_mm": 1e3 * max(self._com_errors),
            "base_height_rms_mm": 1e3 * _rms(self._height_errors),
            "roll_pitch_rms_deg": math.degrees(_rms(self._tilt_errors)),
            "foot_slip_max_mm": 1e3 * self._slip_max,
            "torque_max_nm": max(self._torque_peaks),
            "torque_limit_share": self._at_limit / len(self._torque_peaks),
            "cost_of_transport": self._energy / (weight * distance) if distance > _LEAST_DISTANCE_M else None,
            "control_tick_median_us": float(np.median(self._ticks_us)),
            "control_tick_p99_us": float(np.percentile(self._ticks_us, 99)),
            "control_fallbacks": self._fallbacks,
            "state_sha256": self._hash.hexdigest(),
        }


_LEAST_DISTANCE_M = 0.05  # below it a cost of transport says nothing


def _rms(values: list[float]) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def _roll_pitch_error(state: RobotState, telemetry: ControlTelemetry) -> float:
    """Angle in [rad] between the base and its reference, heading apart."""
    roll, pitch, yaw = telemetry.base_rpy_reference.tolist()
    error = rotation_log(rotation_zyx(yaw, pitch, roll).T @ state.rotation_base_to_world)
    return math.hypot(error[0], error[1])
