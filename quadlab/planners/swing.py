"""How a foot travels over the ground between two footholds, as planners see it."""

import numpy as np

from quadlab.geometry.rotations import Array


def swing_blend(fraction: Array) -> Array:
    """Return the share of the next foothold in the position of a swing foot, any shape.

    p(s) = (1 - b) p_lift-off + b p_touch-down with b = 3 s^2 - 2 s^3: the cubic of Winkler 2017, Eq. (13), with zero
    velocity at both ends.

    Args:
        fraction: elapsed share s of the swing, in [0, 1].
    """
    blend: Array = np.asarray(fraction) ** 2 * (3.0 - 2.0 * np.asarray(fraction))
    return blend
