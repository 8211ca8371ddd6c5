"""Motion of the whole robot driven by its base: legs that follow it, and the base that the feet can carry."""

from dataclasses import dataclass

import numpy as np

from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.gains import TrackingGains
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import BASE, JOINTS, VELOCITY_SIZE, Kinematics
from quadlab.robots.legs import LEG_COUNT, joints_of

_STRETCHED = 1e-2  # singular values of a leg's Jacobian below this share of the largest count as zero


@dataclass(frozen=True)
class DrivenMotion:
    """Generalised accelerations that the base decides: u_dot = constant + per_base u_dot_b.

    Attributes:
        constant: with a base that does not accelerate, (18,) in [m/s^2] and [rad/s^2].
        per_base: change with the acceleration of the base in base axes, (18, 6).
    """

    constant: Array
    per_base: Array

    def with_base(self, acceleration: Array) -> Array:
        """Return u_dot, (18,), for an acceleration of the base, (6,) in base axes."""
        moved: Array = self.constant + self.per_base @ acceleration
        return moved


def legs_following_base(kinematics: Kinematics, reference: ControlReference, gains: TrackingGains) -> DrivenMotion:
    """Winkler 2017, Eq. (22): u_dot_j = J_j^+ (p_ddot - J_dot u - J_b u_dot_b), leg by leg.

    A stretched leg, whose Jacobian has a singular value below 1 % of the largest, is not accelerated along that
    direction; if it stands, its foot is then not quite held.

    Args:
        kinematics: measured.
        reference: of the feet; p_ddot of standing feet is zero.
        gains: of the feet in the air.
    """
    constant, per_base = np.zeros(VELOCITY_SIZE), np.eye(VELOCITY_SIZE, 6)
    for leg in range(LEG_COUNT):
        if reference.stance[leg]:
            jacobian, target = kinematics.contact_jacobians[leg], -kinematics.contact_bias[leg]
        else:
            jacobian = kinematics.foot_jacobians[leg]
            target = -kinematics.foot_bias[leg] + gains.acceleration(
                reference.foot_accelerations[leg],
                reference.foot_velocities[leg] - kinematics.foot_velocities[leg],
                reference.foot_positions[leg] - kinematics.foot_positions[leg],
            )
        inverse = np.linalg.pinv(jacobian[:, JOINTS][:, joints_of(leg)], rcond=_STRETCHED)
        constant[JOINTS][joints_of(leg)] = inverse @ target
        per_base[JOINTS][joints_of(leg)] = -inverse @ jacobian[:, BASE]
    return DrivenMotion(constant, per_base)


def carried_base(
    kinematics: Kinematics, contact: Array, motion: DrivenMotion, wanted: Array, rank_tolerance: float
) -> Array:
    """Return the acceleration of the base in its axes, (6,), that is nearest to ``wanted`` and that the feet can give.

    Neither torques nor contact forces work along the motions n of the base about the feet with locked joints,
    J_cb n = 0; M u_dot + h = S^T tau + J_c^T lambda then leaves n^T (M u_dot + h)_b = 0. Two feet have one such n,
    three have none, and a robot in the air has six: its fall. Near counts 1 m/s^2 like 1 rad/s^2.

    Args:
        kinematics: measured.
        contact: J_c of the standing feet, (3k, 18).
        motion: of the legs.
        wanted: accelerations of CoM x and y, of the base's height and of its orientation in the world, (6,) in
            [m/s^2] and [rad/s^2].
        rank_tolerance: singular values of J_cb below this share of the largest count as zero.
    """
    tasks = np.vstack([kinematics.com_jacobian[:2], kinematics.base_jacobian[2:]])
    bias = np.concatenate([kinematics.com_bias[:2], kinematics.base_bias[2:]])
    base_per_task = np.linalg.pinv(tasks @ motion.per_base)
    base = base_per_task @ (wanted - bias - tasks @ motion.constant)
    _, sizes, directions = np.linalg.svd(contact[:, BASE])
    free = directions[np.count_nonzero(sizes > rank_tolerance * sizes.max(initial=0.0)) :]
    inertia = free @ kinematics.mass_matrix[BASE]
    excess = inertia @ motion.with_base(base) + free @ kinematics.nonlinear_effects[BASE]
    change = np.linalg.pinv(inertia @ motion.per_base @ base_per_task) @ excess
    carried: Array = base - base_per_task @ change
    return carried
