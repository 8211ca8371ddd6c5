"""Limits on positions as limits on accelerations (Bellicoso 2016, Eq. 25-27)."""

from typing import Self

from pydantic import model_validator

from quadlab.configuration import Positive, StrictModel
from quadlab.controllers.tasks.task import TaskRows, Variable
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry


class HeightRangeConfig(StrictModel):
    """Between which heights something shall stay.

    Attributes:
        minimum, maximum: as a share of the standing base height.
        look_ahead_s: k_t t_s of Eq. (27) in [s].
    """

    minimum: Positive
    maximum: Positive
    look_ahead_s: Positive

    @model_validator(mode="after")
    def _range_is_not_empty(self) -> Self:
        if self.minimum >= self.maximum:
            raise ValueError(f"minimum must be below maximum; are {self.minimum:g} and {self.maximum:g}")
        return self

    def bounds(self, standing_height: float) -> tuple[float, float]:
        """Return the range in [m] for a robot whose base stands at ``standing_height`` in [m]."""
        return self.minimum * standing_height, self.maximum * standing_height


def position_limit(
    jacobian: Array,
    bias: Array,
    position: Array,
    velocity: Array,
    bounds: tuple[Array | float, Array | float],
    dt: float,
) -> TaskRows:
    """Return rows that keep r + r_dot dt + r_ddot dt^2 / 2 within bounds, r_ddot = J u_dot + J_dot u.

    The rows of Eq. (27) are divided by dt^2 / 2, so that their slacks are accelerations like those of other tasks.

    Args:
        jacobian: J, (m, 18).
        bias: J_dot u, (m,).
        position, velocity: r and r_dot, (m,).
        bounds: r_min and r_max, (m,) or one number for all.
        dt: look-ahead k_t t_s in [s]; the larger, the softer.
    """
    return TaskRows(Variable.ACCELERATION, jacobian, *acceleration_bounds(bias, position, velocity, bounds, dt))


@compiled_entry
def acceleration_bounds(
    bias: Array, position: Array, velocity: Array, bounds: tuple[Array | float, Array | float], dt: float
) -> tuple[Array, Array]:
    """Return the bounds of J u_dot, (m,) each, that ``position_limit`` describes."""
    scale = 2.0 / dt**2
    offset = bias + scale * dt * velocity
    return scale * (bounds[0] - position) - offset, scale * (bounds[1] - position) - offset
