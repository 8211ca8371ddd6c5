"""Decision vector [u_dot, tau], contact forces projected away by a QR factorisation (Bellicoso 2016, II-A and IV-A)."""

import numpy as np
import scipy.linalg

from quadlab.controllers.decision_space import DecisionSpace
from quadlab.controllers.full_space.contact_motion import no_contact_motion
from quadlab.controllers.hierarchy import Level
from quadlab.robots.kinematics import VELOCITY_SIZE, Kinematics
from quadlab.robots.legs import JOINT_COUNT

_BASE = VELOCITY_SIZE - JOINT_COUNT


def accelerations_torques(kinematics: Kinematics, stance_legs: list[int]) -> DecisionSpace:
    """Return x_d = [u_dot, tau], Eq. (14), under Eq. (15) and (16).

    With J_s^T = [Q_c Q_u] [R; 0], Eq. (4), the dynamics are Q_u^T (M u_dot + h) = Q_u^T S^T tau, Eq. (6b), and the
    forces lambda = R^-1 Q_c^T (M u_dot + h - S^T tau), Eq. (7). Rows in forces written with Eq. (7) are Eq. (21) and
    (31), whose printed signs differ.
    """
    contacts = 3 * len(stance_legs)
    jacobian = kinematics.contact_jacobians[stance_legs].reshape(contacts, VELOCITY_SIZE)
    motion = np.hstack([kinematics.mass_matrix, -np.eye(VELOCITY_SIZE)[:, _BASE:]])  # M u_dot - S^T tau = motion x
    orthogonal, triangle = np.linalg.qr(jacobian.T, mode="complete")
    constrained, unconstrained = orthogonal[:, :contacts], orthogonal[:, contacts:]
    to_forces = scipy.linalg.solve_triangular(triangle[:contacts], constrained.T)
    dynamics_target = -unconstrained.T @ kinematics.nonlinear_effects
    return DecisionSpace(
        linear=np.concatenate([np.eye(VELOCITY_SIZE + JOINT_COUNT), to_forces @ motion]),
        offset=np.concatenate([np.zeros(VELOCITY_SIZE + JOINT_COUNT), to_forces @ kinematics.nonlinear_effects]),
        constraints=(
            Level("dynamics", unconstrained.T @ motion, dynamics_target, dynamics_target),
            no_contact_motion(kinematics, stance_legs, VELOCITY_SIZE + JOINT_COUNT),
        ),
    )
