"""Contact forces that push and do not slip: friction pyramids on the ground plane (Bellicoso 2016, Eq. 29-30)."""

from typing import Literal

import numpy as np

from quadlab.configuration import NonNegative, Positive, StrictModel, register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows, Variable, empty_rows
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import LEG_COUNT


@register("task", "friction_cone")
class FrictionCone:
    """|h^T f| <= mu n^T f, |l^T f| <= mu n^T f and f_min <= n^T f <= f_max for each standing leg.

    Eq. 29 as printed negates two of its rows; here both signs of both tangents h and l are bounded.
    """

    class Config(StrictModel):
        """Friction that the controller believes in.

        Attributes:
            friction: coefficient mu; below the real one, as the pyramid is circumscribed about the cone.
            minimum_normal_force_share: of the robot's weight, kept on each standing leg (as far as its limit allows).
        """

        task: Literal["friction_cone"]
        friction: Positive
        minimum_normal_force_share: NonNegative

    def __init__(self, config: Config) -> None:
        self.config = config
        mu = config.friction
        sides = [[1.0, 0.0, -mu], [-1.0, 0.0, -mu], [0.0, 1.0, -mu], [0.0, -1.0, -mu]]
        self._pyramid = np.array([*sides, [0.0, 0.0, 1.0]])
        size = len(self._pyramid)
        self._rows = [empty_rows(Variable.FORCE, size * legs, 3 * legs) for legs in range(LEG_COUNT + 1)]

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return five rows in forces for each standing leg."""
        floor = self.config.minimum_normal_force_share * reference.weight
        rows = self._rows[len(reference.stance_legs)]
        _write_pyramids(
            self._pyramid,
            floor,
            reference.ground_axes,
            reference.stance,
            reference.normal_force_limits,
            (rows.matrix, rows.lower, rows.upper),
        )
        return rows


@compiled_entry
def _write_pyramids(
    pyramid: Array,
    floor: float,
    ground_axes: Array,
    stance: BoolArray,
    limits: Array,
    rows: tuple[Array, Array, Array],
) -> None:
    """Write the rows of n standing legs.

    Args:
        pyramid: rows in the axes of the ground, (5, 3), the normal force last.
        floor: f_min in [N], as far as the limits allow.
        ground_axes: columns heading, lateral and normal, (3, 3).
        stance: which legs stand, (4,).
        limits: f_max of each leg, (4,) in [N].
        rows: matrix (5 n, 3 n), lower and upper (5 n,) to write to.
    """
    matrix, lower, upper = rows
    matrix[:], lower[:], upper[:] = 0.0, -np.inf, 0.0
    first_row, first_column, size = 0, 0, len(pyramid)
    for leg in range(len(stance)):
        if not stance[leg]:
            continue
        for side in range(size):
            for axis in range(3):
                for ground in range(3):
                    matrix[first_row + side, first_column + axis] += pyramid[side, ground] * ground_axes[axis, ground]
        first_row, first_column = first_row + size, first_column + 3
        lower[first_row - 1], upper[first_row - 1] = min(floor, limits[leg]), limits[leg]
