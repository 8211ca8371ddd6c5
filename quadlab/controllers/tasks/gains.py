"""Gains of a tracked motion."""

from quadlab.configuration import NonNegative, StrictModel
from quadlab.geometry.rotations import Array


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
