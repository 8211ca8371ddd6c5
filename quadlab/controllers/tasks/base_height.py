"""Height of the base over the ground (Bellicoso 2016, Table I, "main body height")."""

from typing import Literal

from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.gains import TrackingGains
from quadlab.controllers.tasks.task import TaskRows, Variable, empty_equation
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry
from quadlab.robots.kinematics import VELOCITY_SIZE, Kinematics


@register("task", "base_height")
class BaseHeightTask:
    """J_B,z u_dot = - K_d z_dot + K_p (z_ref - z) - J_dot u."""

    class Config(TrackingGains):
        """Gains of the vertical base motion."""

        task: Literal["base_height"]

    def __init__(self, config: Config) -> None:
        self.config = config
        self._rows = empty_equation(Variable.ACCELERATION, 1, VELOCITY_SIZE)

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return one row in accelerations."""
        _write_row(
            self.config.proportional_per_s2,
            self.config.derivative_per_s,
            reference.base_height,
            (kinematics.base_position, kinematics.base_linear_velocity, kinematics.base_bias),
            kinematics.base_jacobian,
            (self._rows.matrix, self._rows.upper),
        )
        return self._rows


@compiled_entry
def _write_row(
    proportional_per_s2: float,
    derivative_per_s: float,
    height: float,
    measured: tuple[Array, Array, Array],
    jacobian: Array,
    rows: tuple[Array, Array],
) -> None:
    """Write J_B,z (1, 18) and what J_B,z u_dot shall be (1,) to ``rows``.

    Args:
        proportional_per_s2, derivative_per_s: gains.
        height: z_ref in [m].
        measured: position and velocity of the base, (3,), and its J_dot u, (6,).
        jacobian: of the base, (6, 18).
        rows: matrix and target.
    """
    position, velocity, bias = measured
    matrix, target = rows
    matrix[0] = jacobian[2]
    target[0] = proportional_per_s2 * (height - position[2]) - derivative_per_s * velocity[2] - bias[2]
