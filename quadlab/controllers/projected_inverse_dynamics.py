"""Projected inverse dynamics: reference accelerations, contact forces projected away (Winkler 2017, IV)."""

from enum import StrEnum
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from quadlab.configuration import StrictModel, register
from quadlab.controllers.controller_config import TrackingControllerConfig
from quadlab.controllers.driven_motion import DrivenMotion, carried_base, legs_following_base
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.resolver import Resolution
from quadlab.controllers.tasks.gains import TrackingGains
from quadlab.geometry.rotations import Array, rotation_log
from quadlab.robots.kinematics import BASE, JOINTS, VELOCITY_SIZE, Kinematics
from quadlab.robots.legs import LEG_COUNT


class BaseGains(StrictModel):
    """Error dynamics of the base and of the feet in the air.

    Attributes:
        horizontal, height, orientation, feet: see ``TrackingGains``.
    """

    horizontal: TrackingGains
    height: TrackingGains
    orientation: TrackingGains
    feet: TrackingGains


class Redundancy(StrEnum):
    """What is smallest where many torques give one motion, since feet can be squeezed against each other."""

    FORCES = "forces"
    """The contact forces, whose tangential parts then are as small as the motion allows."""
    TORQUES = "torques"
    """The torques, as printed: a foot with little load may be pushed sideways harder than friction holds."""


@register("controller", "projected_inverse_dynamics")
class ProjectedInverseDynamicsResolver:
    """P S^T tau = P (M q_ddot_ref + h) with P = I - J_c^+ J_c, Eq. (23), of a motion that the feet can carry.

    Deviations from the paper:

    - Feedback is negative, K_p (q_ref - q) + K_d (q_dot_ref - q_dot); the printed sign is not.
    - The horizontal acceleration is that of the CoM, with all that the legs add to it. "Geometric centre = CoM" leaves
      an offset on a robot that is not symmetric, and an error with every swing of a heavy leg.
    - q_ddot_ref is changed to the nearest that the standing feet can give (``carried_base``). Two feet cannot turn the
      base about the line between them, and what Eq. (23) then leaves over acts on all joints: the base topples.
    - Feet do not pull: one that would have to is taken to carry nothing.
    - Of the torques of one motion those with the least contact forces are taken (Righetti 2013); the printed
      pseudo-inverse takes the least torques, which push a foot with little load sideways until it slips.
    - What is tracked is that of the other controllers: plans are aligned with the feet, footholds answer errors of
      velocity, lift-offs wait for balance, late feet search the ground, swings are quintics with an arc of their own,
      and roll and pitch follow half the slope of a fitted plane, over which heights count. The paper has none of it.
    - The feedback of the joints begins anew from the measured joints in every tick: it damps within a control period
      and corrects no error that has gathered.

    Friction and torque limits are no part of it; the simulator clips torques.
    """

    class Config(TrackingControllerConfig):
        """Gains and tracking.

        Attributes:
            gains: error dynamics.
            redundancy: what is smallest among the torques of one motion.
            rank_tolerance: singular values below this share of the largest count as zero in all pseudo-inverses of
                contacts; below 1.
        """

        kind: Literal["projected_inverse_dynamics"]
        gains: BaseGains
        redundancy: Redundancy
        rank_tolerance: Annotated[float, Field(gt=0.0, lt=1.0)]

    def __init__(self, config: Config) -> None:
        self.config = config
        self.level_names = ("base", "feet")
        self.limit_names = ()

    def resolve(self, kinematics: Kinematics, reference: ControlReference, last_torques: Array) -> Resolution:
        """Return the torques of Eq. (22)-(23)."""
        motion = legs_following_base(kinematics, reference, self.config.gains.feet)
        wanted = self._task_accelerations(kinematics, reference)
        legs = list(reference.stance_legs)
        while True:
            resolution = self._carried(kinematics, motion, wanted, legs)
            loads = resolution.contact_forces @ reference.ground_axes[:, 2]
            if not np.any(loads < 0.0):
                return resolution
            legs.remove(int(np.argmin(loads)))

    def _carried(self, kinematics: Kinematics, motion: DrivenMotion, wanted: Array, legs: list[int]) -> Resolution:
        """Return the motion nearest to ``wanted`` that the feet of ``legs`` carry, and its torques and forces."""
        contact = kinematics.contact_jacobians[legs].reshape(-1, VELOCITY_SIZE)
        base = carried_base(kinematics, contact, motion, wanted, self.config.rank_tolerance)
        accelerations = motion.with_base(base)
        inverse_dynamics = kinematics.mass_matrix @ accelerations + kinematics.nonlinear_effects
        torques, forces = self._torques_and_forces(contact, inverse_dynamics)
        residual = inverse_dynamics - contact.T @ forces
        residual[JOINTS] -= torques
        finite = bool(np.isfinite(torques).all())
        contact_forces = np.zeros((LEG_COUNT, 3))
        contact_forces[legs] = forces.reshape(-1, 3)
        return Resolution(
            torques=torques,
            accelerations=accelerations,
            contact_forces=contact_forces,
            residuals={"base": float(np.linalg.norm(residual[BASE])), "feet": float(np.linalg.norm(residual[JOINTS]))},
            iterations=0,
            solved=finite,
            reason="" if finite else "torques that are not finite",
        )

    def _torques_and_forces(self, contact: Array, inverse_dynamics: Array) -> tuple[Array, Array]:
        """Return torques, (12,) in [N m], and forces of the standing feet, (3k,) in [N].

        Args:
            contact: J_c, (3k, 18).
            inverse_dynamics: M q_ddot_ref + h, (18,).
        """
        if self.config.redundancy is Redundancy.FORCES:
            forces = self._inverse(contact[:, BASE].T) @ inverse_dynamics[BASE]
            return (inverse_dynamics - contact.T @ forces)[JOINTS], forces
        projection = np.eye(VELOCITY_SIZE) - self._inverse(contact) @ contact
        torques = self._inverse(projection[:, JOINTS]) @ (projection @ inverse_dynamics)
        unexplained = inverse_dynamics.copy()
        unexplained[JOINTS] -= torques
        return torques, self._inverse(contact.T) @ unexplained

    def _inverse(self, matrix: Array) -> Array:
        return np.asarray(np.linalg.pinv(matrix, rcond=self.config.rank_tolerance), dtype=np.float64)

    def _task_accelerations(self, kinematics: Kinematics, reference: ControlReference) -> Array:
        """Desired accelerations of CoM x and y, of the base's height and of its orientation in the world, (6,)."""
        gains = self.config.gains
        horizontal = gains.horizontal.acceleration(
            reference.com_acceleration,
            reference.com_velocity - kinematics.com_velocity[:2],
            reference.com_position - kinematics.com_position[:2],
        )
        height = gains.height.acceleration(
            reference.base_acceleration[2:],
            reference.base_velocity[2:] - kinematics.base_linear_velocity[2:],
            np.array([reference.base_height - kinematics.base_position[2]]),
        )
        angular = gains.orientation.acceleration(
            reference.base_angular_acceleration,
            reference.base_angular_velocity - kinematics.base_angular_velocity,
            rotation_log(reference.base_rotation @ kinematics.base_rotation.T),
        )
        return np.concatenate([horizontal, height, angular])
