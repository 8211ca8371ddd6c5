"""Projected inverse dynamics: reference accelerations, contact forces projected away (Winkler 2017, IV)."""

from typing import Literal

import numpy as np

from quadlab.configuration import Positive, StrictModel, register
from quadlab.controllers.controller_config import TrackingControllerConfig
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.resolver import Resolution
from quadlab.controllers.tasks.gains import TrackingGains
from quadlab.geometry.rotations import Array, rotation_log
from quadlab.robots.kinematics import BASE, JOINTS, Kinematics
from quadlab.robots.legs import LEG_COUNT, joints_of


class BaseGains(StrictModel):
    """Error dynamics of the base and of the feet in the air.

    Attributes:
        horizontal, height, orientation, feet: see ``TrackingGains``.
    """

    horizontal: TrackingGains
    height: TrackingGains
    orientation: TrackingGains
    feet: TrackingGains


@register("controller", "projected_inverse_dynamics")
class ProjectedInverseDynamicsResolver:
    """tau = (P S^T)^+ P (M q_ddot_ref + h) with P = I - J_c^+ J_c, Eq. (23).

    Feedback is negative, K_p (q_ref - q) + K_d (q_dot_ref - q_dot); the printed sign is not. The base follows the
    CoM's horizontal error, since "geometric centre = CoM" leaves a constant offset on a robot that is not symmetric.
    Friction and torque limits are no part of it; the simulator clips torques.
    """

    class Config(TrackingControllerConfig):
        """Gains and tracking.

        Attributes:
            gains: error dynamics.
            rank_tolerance: singular values below this share of the largest count as zero in both pseudo-inverses.
        """

        kind: Literal["projected_inverse_dynamics"]
        gains: BaseGains
        rank_tolerance: Positive

    def __init__(self, config: Config) -> None:
        self.config = config
        self.level_names = ("base", "feet")

    def resolve(self, kinematics: Kinematics, reference: ControlReference, last_torques: Array) -> Resolution:
        """Return the torques of Eq. (22)-(23)."""
        accelerations = np.zeros(len(kinematics.generalized_velocity))
        accelerations[BASE] = self._base_acceleration(kinematics, reference)
        accelerations[JOINTS] = self._joint_accelerations(kinematics, reference, accelerations[BASE])
        inverse_dynamics = kinematics.mass_matrix @ accelerations + kinematics.nonlinear_effects
        legs = reference.stance_legs
        contact = kinematics.contact_jacobians[legs].reshape(-1, len(accelerations))
        tolerance = self.config.rank_tolerance
        projection = np.eye(len(accelerations)) - np.linalg.pinv(contact, rcond=tolerance) @ contact
        torques = np.linalg.pinv(projection[:, JOINTS], rcond=tolerance) @ (projection @ inverse_dynamics)
        unexplained = inverse_dynamics.copy()
        unexplained[JOINTS] -= torques
        forces = np.zeros((LEG_COUNT, 3))
        forces[legs] = np.linalg.lstsq(contact.T, unexplained, rcond=None)[0].reshape(-1, 3)
        residual = unexplained - contact.T @ forces[legs].ravel()
        return Resolution(
            torques=torques,
            accelerations=accelerations,
            contact_forces=forces,
            residuals={"base": float(np.linalg.norm(residual[BASE])), "feet": float(np.linalg.norm(residual[JOINTS]))},
            iterations=0,
            solved=bool(np.isfinite(torques).all()),
        )

    def _base_acceleration(self, kinematics: Kinematics, reference: ControlReference) -> Array:
        """Desired linear and angular acceleration of the base in its own axes, (6,)."""
        gains = self.config.gains
        linear = np.empty(3)
        linear[:2] = gains.horizontal.acceleration(
            reference.com_acceleration,
            reference.com_velocity - kinematics.com_velocity[:2],
            reference.com_position - kinematics.com_position[:2],
        )
        linear[2:] = gains.height.acceleration(
            0.0,
            -kinematics.base_linear_velocity[2:],
            np.array([reference.base_height - kinematics.base_position[2]]),
        )
        angular = gains.orientation.acceleration(
            0.0,
            reference.base_angular_velocity - kinematics.base_angular_velocity,
            rotation_log(reference.base_rotation @ kinematics.base_rotation.T),
        )
        rotation = kinematics.base_rotation
        target = np.concatenate([linear, angular]) - kinematics.base_bias
        return np.concatenate([rotation.T @ target[:3], rotation.T @ target[3:]])

    def _joint_accelerations(self, kinematics: Kinematics, reference: ControlReference, base: Array) -> Array:
        """Eq. (22): q_ddot_j = J_j^+ (p_ddot - J_dot q_dot - J_b q_ddot_b), leg by leg, (12,)."""
        gains = self.config.gains.feet
        joints = np.empty(LEG_COUNT * 3)
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
            own = jacobian[:, JOINTS][:, joints_of(leg)]
            joints[joints_of(leg)] = np.linalg.pinv(own, rcond=1e-2) @ (target - jacobian[:, BASE] @ base)
        return joints
