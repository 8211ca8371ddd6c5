"""Contact forces that push and do not slip: friction pyramids on the ground plane (Bellicoso 2016, Eq. 29-30)."""

from typing import Literal

import numpy as np

from quadlab.configuration import NonNegative, Positive, StrictModel, register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows, Variable
from quadlab.robots.kinematics import Kinematics


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

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return five rows in forces for each standing leg."""
        limits = reference.normal_force_limits[reference.stance]
        count, size = len(limits), len(self._pyramid)
        matrix = np.zeros((count, size, count, 3))
        pyramid = self._pyramid @ reference.ground_axes.T
        for leg in range(count):
            matrix[leg, :, leg] = pyramid
        lower, upper = np.full((count, size), -np.inf), np.zeros((count, size))
        lower[:, -1] = np.minimum(self.config.minimum_normal_force_share * reference.weight, limits)
        upper[:, -1] = limits
        return TaskRows(Variable.FORCE, matrix.reshape(size * count, 3 * count), lower.ravel(), upper.ravel())
