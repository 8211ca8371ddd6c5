"""Contact forces that push and do not slip: friction pyramids on the ground plane (Bellicoso 2016, Eq. 29-30)."""

from typing import Literal

import numpy as np

from quadlab.configuration import NonNegative, Positive, StrictModel, register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows, Variable
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics


@register("task", "friction_cone")
class FrictionCone:
    """|h^T f| <= mu n^T f, |l^T f| <= mu n^T f and f_min <= n^T f <= f_max for each standing leg.

    Eq. 29 as printed negates two of its rows; here both signs of both tangents are bounded.
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

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return five rows in forces for each standing leg."""
        legs = reference.stance_legs
        pyramid = self._pyramid(reference.ground_axes)
        matrix = np.asarray(np.kron(np.eye(len(legs)), pyramid), dtype=np.float64)
        limits = reference.normal_force_limits[legs]
        floor = self.config.minimum_normal_force_share * reference.weight
        lower = np.full((len(legs), len(pyramid)), -np.inf)
        upper = np.zeros((len(legs), len(pyramid)))
        lower[:, -1], upper[:, -1] = np.minimum(floor, limits), limits
        return TaskRows(Variable.FORCE, matrix, lower.ravel(), upper.ravel())

    def _pyramid(self, ground_axes: Array) -> Array:
        heading, lateral, normal = ground_axes.T
        mu = self.config.friction
        return np.stack(
            [heading - mu * normal, -heading - mu * normal, lateral - mu * normal, -lateral - mu * normal, normal]
        )
