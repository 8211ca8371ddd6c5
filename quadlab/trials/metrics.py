"""What a trial amounts to in numbers, collected tick by tick.

Errors are measured from the truth, against references that live in the world the controller believes in. If its state
is estimated, the drift of the estimate (position and heading cannot be observed) is a part of them;
``EstimationMetrics`` tells how large it is and what error the controller saw.
"""

import hashlib
import math
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from quadlab.constants import GRAVITY
from quadlab.controllers.telemetry import ControlTelemetry, LegMode
from quadlab.geometry.rotations import Array
from quadlab.robots.legs import LEG_COUNT
from quadlab.robots.state import JointCommand, RobotState

_AT_LIMIT = 0.999  # share of the torque limit that counts as being at it


_LEAST_DISTANCE_M = 0.05  # below it a cost of transport says nothing

_WIDTHS = {
    "time": 1,
    "tick_us": 1,
    "height_reference": 1,
    "position": 3,
    "quat": 4,
    "rpy_reference": 3,
    "com": 3,
    "com_reference": 3,
    "torques": 12,
    "joint_velocities": 12,
    "foot_velocities": 12,
    "foot_forces": 12,
}
_ENDS = np.cumsum([0, *_WIDTHS.values()]).tolist()
_COLUMNS = {name: slice(*ends) for name, ends in zip(_WIDTHS, pairwise(_ENDS), strict=True)}
"""Where the numbers of a tick stand in its row."""


@dataclass
class TrialMetrics:
    """Keeps one row of numbers a tick; ``summary`` makes the metrics of ``TrialResult`` of them.

    Attributes:
        mass: of the simulated robot, payload included, in [kg].
        torque_limits: (12,) in [N m].
        period_s: control period in [s].
        limit_names: of the controller's residuals that no tick should have.
        torque_scale: what the drives give of a torque that is asked for.
    """

    mass: float
    torque_limits: Array
    period_s: float
    limit_names: tuple[str, ...] = ()
    torque_scale: float = 1.0
    _rows: list[Array] = field(default_factory=list)
    _modes: list[tuple[LegMode, ...]] = field(default_factory=list)
    _fallbacks: int = 0
    _limit_residual: float = 0.0
    _hash: "hashlib._Hash" = field(default_factory=hashlib.sha256)

    def add(self, state: RobotState, command: JointCommand, telemetry: ControlTelemetry, physics_state: Array) -> None:
        """Take in one tick.

        Args:
            state: true state at its start.
            command: torques asked of the drives (within the limits), with joint feedback those of the tick's last
                physics step.
            telemetry: of the controller, its measured quantities replaced by the true ones.
            physics_state: everything the simulator integrates; goes into the hash.
        """
        parts = (
            np.array([state.time_s, telemetry.tick_us, telemetry.base_height_reference]),
            state.position_base_in_world,
            state.quat_wxyz,
            telemetry.base_rpy_reference,
            telemetry.com_position,
            telemetry.com_position_reference,
            command.torques,
            state.joint_velocities,
            telemetry.foot_contact_velocities.ravel(),
            state.foot_forces_in_world.ravel(),
        )
        self._rows.append(np.concatenate(parts))
        self._modes.append(telemetry.leg_modes)
        self._fallbacks = telemetry.fallbacks
        for name in self.limit_names:  # NaN in a tick without a solution, which counts as a fallback, changes nothing
            self._limit_residual = max(self._limit_residual, telemetry.level_residuals[name])
        self._hash.update(np.ascontiguousarray(physics_state).tobytes())

    @property
    def distance_m(self) -> float:
        """How far the base has come over the ground in [m]."""
        if not self._rows:
            return 0.0
        start, end = (row[_COLUMNS["position"]] for row in (self._rows[0], self._rows[-1]))
        return math.dist(start[:2], end[:2])

    def summary(self) -> dict[str, float | int | str | None]:
        """Return the metrics by their names in ``TrialResult``; empty if there was no tick."""
        if not self._rows:
            return {}
        rows = np.array(self._rows)
        ticks = {name: rows[:, columns] for name, columns in _COLUMNS.items()}
        distance, weight = self.distance_m, self.mass * GRAVITY
        survived = float(ticks["time"][-1, 0] + self.period_s - ticks["time"][0, 0])
        com_errors = np.linalg.norm((ticks["com"] - ticks["com_reference"])[:, :2], axis=1)
        torques = np.abs(ticks["torques"])
        power = self.torque_scale * np.abs(ticks["torques"] * ticks["joint_velocities"])
        energy = float(power.sum()) * self.period_s
        return {
            "survived_s": survived,
            "distance_m": distance,
            "mean_speed_mps": distance / survived,
            "com_error_rms_mm": 1e3 * rms(com_errors),
            "com_error_max_mm": 1e3 * float(com_errors.max()),
            "base_height_rms_mm": 1e3 * rms(ticks["position"][:, 2] - ticks["height_reference"][:, 0]),
            "roll_pitch_rms_deg": math.degrees(rms(_roll_pitch_errors(ticks["quat"], ticks["rpy_reference"]))),
            "foot_slip_max_mm": 1e3 * self._longest_slip(ticks["foot_velocities"], ticks["foot_forces"]),
            "torque_max_nm": float(torques.max()),
            "torque_limit_share": float((torques >= _AT_LIMIT * self.torque_limits).any(axis=1).mean()),
            "limit_residual_max": self._limit_residual if self.limit_names else None,
            "cost_of_transport": energy / (weight * distance) if distance > _LEAST_DISTANCE_M else None,
            "control_tick_median_us": float(np.median(ticks["tick_us"])),
            "control_tick_p99_us": float(np.percentile(ticks["tick_us"], 99)),
            "control_fallbacks": self._fallbacks,
            "state_sha256": self._hash.hexdigest(),
        }

    def _longest_slip(self, velocities: Array, forces: Array) -> float:
        """Return the longest way in [m] of the material point under a standing, loaded foot in one stance.

        Args:
            velocities, forces: of the feet, (ticks, 12) in [m/s] and [N].
        """
        speeds = np.linalg.norm(velocities.reshape(-1, LEG_COUNT, 3)[:, :, :2], axis=2)
        loaded = forces.reshape(-1, LEG_COUNT, 3)[:, :, 2] > 0.0
        stands = np.array(self._modes) == LegMode.STANCE
        way = np.cumsum(np.where(stands & loaded, speeds, 0.0) * self.period_s, axis=0)
        before_stance = np.maximum.accumulate(np.where(stands, 0.0, way), axis=0)
        return float((way - before_stance).max())


def rms(values: Array) -> float:
    """Return the root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def _roll_pitch_errors(quats: Array, rpy_references: Array) -> Array:
    """Angles in [rad] between base, quaternions (ticks, 4), and reference, (ticks, 3), heading apart."""
    references = Rotation.from_euler("ZYX", rpy_references[:, ::-1])
    errors = (references.inv() * Rotation.from_quat(quats, scalar_first=True)).as_rotvec()
    angles: Array = np.hypot(errors[:, 0], errors[:, 1])
    return angles
