"""Motion of the feet in the air (Bellicoso 2016, Eq. 19)."""

from typing import Literal

from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.gains import TrackingGains
from quadlab.controllers.tasks.task import TaskRows, Variable, empty_equation
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry
from quadlab.robots.kinematics import VELOCITY_SIZE, Kinematics
from quadlab.robots.legs import LEG_COUNT


@register("task", "swing_feet")
class SwingFeetTask:
    """J_F u_dot = r_ddot_ref + K_d (r_dot_ref - r_dot) + K_p (r_ref - r) - J_dot u for each foot in the air.

    In world axes, where the paper writes the rows in its control frame: with one gain for all axes that is the same.
    """

    class Config(TrackingGains):
        """Gains of the foot motion."""

        task: Literal["swing_feet"]

    def __init__(self, config: Config) -> None:
        self.config = config
        self._rows = [empty_equation(Variable.ACCELERATION, 3 * legs, VELOCITY_SIZE) for legs in range(LEG_COUNT + 1)]

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return three rows in accelerations for each leg in the air."""
        rows = self._rows[LEG_COUNT - len(reference.stance_legs)]
        if not len(rows.upper):
            return rows
        _write_swing_rows(
            self.config.proportional_per_s2,
            self.config.derivative_per_s,
            reference.stance,
            (reference.foot_accelerations, reference.foot_velocities, reference.foot_positions),
            (kinematics.foot_bias, kinematics.foot_velocities, kinematics.foot_positions),
            kinematics.foot_jacobians,
            (rows.matrix, rows.upper),
        )
        return rows


@compiled_entry
def _write_swing_rows(
    proportional: float,
    derivative: float,
    stance: BoolArray,
    reference: tuple[Array, Array, Array],
    measured: tuple[Array, Array, Array],
    jacobians: Array,
    rows: tuple[Array, Array],
) -> None:
    """Write J_F (3 n, 18) and what J_F u_dot shall be, (3 n,), of the n legs in the air to ``rows``.

    ``reference`` and ``measured`` are acceleration (measured: J_dot u), velocity and position of all feet, (4, 3) each.
    """
    legs, axes, _ = jacobians.shape
    matrix, target = rows
    row = 0
    for leg in range(legs):
        if stance[leg]:
            continue
        for axis in range(axes):
            acceleration, velocity, position = (
                reference[0][leg, axis] - measured[0][leg, axis],
                reference[1][leg, axis] - measured[1][leg, axis],
                reference[2][leg, axis] - measured[2][leg, axis],
            )
            target[row] = acceleration + derivative * velocity + proportional * position
            matrix[row] = jacobians[leg, axis]
            row += 1
