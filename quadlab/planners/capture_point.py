"""Where to step with one point foot to come to rest: the capture point."""

import numpy as np

from quadlab.constants import GRAVITY
from quadlab.geometry.rotations import Array


def capture_point(com_position: Array, com_velocity: Array, com_height: float, gravity: float = GRAVITY) -> Array:
    """Return the constant CoP u_0 = c_0 + c_dot_0 sqrt(h / g) that brings the pendulum to rest above it, (2,) in [m].

    Winkler 2017, Eq. (5) and (28), which print h / g for the factor; their (26) and (27) give 1 / alpha = sqrt(h / g).

    Args:
        com_position: c_0, (2,) in [m].
        com_velocity: c_dot_0, (2,) in [m/s].
        com_height: h, positive, in [m].
        gravity: g, positive, in [m/s^2].
    """
    point: Array = com_position + com_velocity * np.sqrt(com_height / gravity)
    return point
