"""Standing feet that do not move, as a level (Bellicoso 2016, Eq. 16, with right-hand side -J_dot u)."""

import numpy as np

from quadlab.controllers.hierarchy import Level
from quadlab.robots.kinematics import VELOCITY_SIZE, Kinematics


def no_contact_motion(kinematics: Kinematics, stance_legs: list[int], size: int) -> Level:
    """Return J_c u_dot = -J_dot u in ``size`` decision variables that begin with u_dot."""
    matrix = np.zeros((3 * len(stance_legs), size))
    matrix[:, :VELOCITY_SIZE] = kinematics.contact_jacobians[stance_legs].reshape(-1, VELOCITY_SIZE)
    target = -kinematics.contact_bias[stance_legs].ravel()
    return Level("contacts", matrix, target, target)
