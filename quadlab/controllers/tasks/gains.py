"""Gains of a tracked motion."""

from quadlab.configuration import NonNegative, StrictModel
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled, compiled_entry


class TrackingGains(StrictModel):
    """Error dynamics x_ddot = x_ddot_ref + derivative (x_dot_ref - x_dot) + proportional (x_ref - x).

    Attributes:
        proportional_per_s2: in [1/s^2].
        derivative_per_s: in [1/s].
    """

    proportional_per_s2: NonNegative
    derivative_per_s: NonNegative

    def acceleration(self, feed_forward: Array | float, velocity_error: Array, position_error: Array) -> Array:
        """Return the commanded acceleration; errors are reference minus measured, all of one shape."""
        return feed_forward + self.derivative_per_s * velocity_error + self.proportional_per_s2 * position_error


@compiled
def tracking_target(
    proportional_per_s2: float,
    derivative_per_s: float,
    feed_forward: Array,
    velocities: tuple[Array, Array],
    positions: tuple[Array, Array],
    bias: Array,
    target: Array,
) -> None:
    """Write what J u_dot shall be to ``target``, (m,): the commanded acceleration less the ``bias`` J_dot u.

    Of arrays that are longer the first m numbers count.

    Args:
        proportional_per_s2, derivative_per_s: gains, see ``TrackingGains``.
        feed_forward: x_ddot_ref, (m,).
        velocities, positions: reference and measured, (m,) each.
        bias: (m,).
        target: to write to.
    """
    for i in range(len(target)):
        velocity_error = velocities[0][i] - velocities[1][i]
        position_error = positions[0][i] - positions[1][i]
        commanded = feed_forward[i] + derivative_per_s * velocity_error + proportional_per_s2 * position_error
        target[i] = commanded - bias[i]


@compiled_entry
def write_tracking_rows(
    proportional_per_s2: float,
    derivative_per_s: float,
    feed_forward: Array,
    velocities: tuple[Array, Array],
    positions: tuple[Array, Array],
    bias: Array,
    jacobian: Array,
    rows: tuple[Array, Array],
) -> None:
    """Write J, (m, n), and what J u_dot shall be, (m,), to ``rows``; of longer arrays the first m rows count.

    Arguments as of ``tracking_target``, and ``jacobian`` J of at least m rows.
    """
    matrix, target = rows
    matrix[:] = jacobian[: len(matrix)]
    tracking_target(proportional_per_s2, derivative_per_s, feed_forward, velocities, positions, bias, target)
