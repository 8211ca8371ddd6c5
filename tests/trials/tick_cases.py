"""Ticks of a robot that stands still and is tracked without error, for tests of what is made of a trial's ticks."""

from dataclasses import replace
from typing import Any

import numpy as np
from synthetic_records import CONTROL_PERIOD, tick_record

from quadlab.controllers.telemetry import ControlTelemetry, LegMode
from quadlab.geometry.rotations import matrix_to_quat, rotation_zyx
from quadlab.robots.state import RobotState

HEIGHT_M = 0.5
FOOT_FORCES = np.tile([0.0, 0.0, 75.0], (4, 1))  # [N]


def still_state(index: int = 0, **changes: Any) -> RobotState:
    still = replace(
        tick_record(0).state,
        time_s=index * CONTROL_PERIOD,
        position_base_in_world=np.array([0.0, 0.0, HEIGHT_M]),
        quat_wxyz=turned(),
        linear_velocity_base_in_world=np.zeros(3),
        joint_velocities=np.zeros(12),
        foot_forces_in_world=FOOT_FORCES,
    )
    return replace(still, **changes)


def turned(yaw: float = 0.0, pitch: float = 0.0, roll: float = 0.0) -> np.ndarray:
    """Quaternion of a base that is turned so, in [rad]."""
    return matrix_to_quat(rotation_zyx(yaw, pitch, roll))


def exact_telemetry(**changes: Any) -> ControlTelemetry:
    still = tick_record(0).telemetry._replace(
        com_position=np.zeros(3),
        com_position_reference=np.zeros(3),
        base_height_reference=HEIGHT_M,
        base_rpy_reference=np.zeros(3),
        terrain_plane=np.zeros(3),
        foot_contact_velocities=np.zeros((4, 3)),
        leg_modes=(LegMode.STANCE,) * 4,
        level_residuals={"torque": 0.0, "friction": 0.0},
    )
    return still._replace(**changes)
