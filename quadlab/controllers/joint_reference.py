"""References for the drives: where the joints should be within the next control period (Gehring 2017, III-B)."""

import numpy as np

from quadlab.controllers.controller_config import JointPdConfig
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.resolver import Resolution
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import BASE, JOINTS, Kinematics
from quadlab.robots.legs import joints_of
from quadlab.robots.state import JointCommand, JointDrive

_DAMPING = 0.02  # [m/rad] of the inverse kinematics: joints stay calm near a stretched knee
_LARGEST_STEP = 0.2  # [rad] of the inverse kinematics in one tick


def damped_inverse(jacobian: Array, damping: float = _DAMPING) -> Array:
    """Return J^T (J J^T + damping^2 I)^-1 (Nakamura 1986), (3, 3), for a (3, 3) Jacobian in [m/rad]."""
    gram = jacobian @ jacobian.T + damping**2 * np.eye(3)
    return np.asarray(np.linalg.solve(gram, jacobian).T, dtype=np.float64)


def driven_command(
    config: JointPdConfig, kinematics: Kinematics, reference: ControlReference, resolution: Resolution
) -> JointCommand:
    """Return torques and what the drives shall hold.

    Args:
        config: gains, and the torques of legs in the air.
        kinematics: measured.
        reference: for the feet.
        resolution: for torques and expected accelerations.
    """
    drive = joint_drive(config, kinematics, reference, resolution)
    if config.swing_torques == "solved":
        return JointCommand(resolution.torques, drive)
    return JointCommand(_holding_torques(kinematics, reference, resolution, drive), drive)


def _holding_torques(
    kinematics: Kinematics, reference: ControlReference, resolution: Resolution, drive: JointDrive
) -> Array:
    """Return the solved torques but for legs in the air, whose torques give their joints the drives' accelerations."""
    accelerations = np.concatenate([resolution.accelerations[BASE], drive.accelerations])
    holding = kinematics.mass_matrix[JOINTS] @ accelerations + kinematics.nonlinear_effects[JOINTS]
    torques = resolution.torques.copy()
    for leg in reference.swing_legs:
        torques[joints_of(leg)] = holding[joints_of(leg)]
    return torques


def joint_drive(
    config: JointPdConfig, kinematics: Kinematics, reference: ControlReference, resolution: Resolution
) -> JointDrive:
    """Return what the drives shall hold.

    Joints of standing legs follow the accelerations that the controller expects from where they are. Joints of legs in
    the air follow the foot's reference by one step of damped least-squares inverse kinematics a tick.

    Args:
        config: gains.
        kinematics: measured.
        reference: for the feet.
        resolution: for the expected accelerations.
    """
    positions = kinematics.joint_positions.copy()
    velocities = kinematics.generalized_velocity[JOINTS].copy()
    accelerations = resolution.accelerations[JOINTS].copy()
    for leg in reference.swing_legs:
        joints = joints_of(leg)
        inverse = damped_inverse(kinematics.foot_jacobians[leg][:, JOINTS][:, joints])
        position_error = reference.foot_positions[leg] - kinematics.foot_positions[leg]
        velocity_error = reference.foot_velocities[leg] - kinematics.foot_velocities[leg]
        positions[joints] += np.clip(inverse @ position_error, -_LARGEST_STEP, _LARGEST_STEP)
        velocities[joints] += inverse @ velocity_error
        accelerations[joints] = 0.0
    return JointDrive(
        positions, velocities, accelerations, config.proportional_nm_per_rad, config.derivative_nms_per_rad
    )
