"""Decision vector [u_dot, lambda] (Gehring 2017, III-C)."""

import numpy as np

from quadlab.controllers.decision_space import DecisionSpace
from quadlab.controllers.full_space.contact_motion import no_contact_motion
from quadlab.controllers.hierarchy import Level
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import BASE, JOINTS, VELOCITY_SIZE, Kinematics


def accelerations_forces(kinematics: Kinematics, stance_legs: list[int]) -> DecisionSpace:
    """Return x = [u_dot, lambda] under the equations of motion of the base and "no contact motion".

    The base rows are M_b u_dot - J_cb^T lambda = -h_b, Eq. (14), whose printed signs do not agree with Eq. (13). The
    joint rows give the torques, tau = M_j u_dot + h_j - J_cj^T lambda. The paper puts friction between the two
    constraints; here both stand above it, which makes no difference where forces exist that satisfy all three.
    """
    jacobian = kinematics.contact_jacobians[stance_legs].reshape(3 * len(stance_legs), VELOCITY_SIZE)
    motion = np.hstack([kinematics.mass_matrix, -jacobian.T])
    identity = np.eye(motion.shape[1])
    base_target = -kinematics.nonlinear_effects[BASE]
    return DecisionSpace(
        linear=np.concatenate([identity[:VELOCITY_SIZE], motion[JOINTS], identity[VELOCITY_SIZE:]]),
        offset=_offset(kinematics, len(jacobian)),
        constraints=(
            Level("dynamics", motion[BASE], base_target, base_target),
            no_contact_motion(kinematics, stance_legs, motion.shape[1]),
        ),
    )


def _offset(kinematics: Kinematics, forces: int) -> Array:
    return np.concatenate([np.zeros(VELOCITY_SIZE), kinematics.nonlinear_effects[JOINTS], np.zeros(forces)])
