"""Eq. (3), first line: the auxiliary CoM is the centre of mass of the configuration."""

from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import Coordinates, Jacobians
from quadlab.robots.pinocchio_model import IndexArray


@dataclass(frozen=True)
class ComConsistency:
    """Residual r_COM(q_i) - x_i of every sample.

    Attributes:
        layout: of p.
        weight: in [1/m^2].
        variables: q_i and x_i, (N, 21).
    """

    layout: SampleLayout
    weight: float
    variables: IndexArray
    name: str = "com_consistency"

    def residual(self, p: Array, coordinates: Coordinates) -> Array:
        """Return r_COM(q_i) - x_i, (N, 3) in [m]."""
        difference: Array = coordinates.com - self.layout.value("com", p)
        return difference

    def jacobian(self, p: Array, jacobians: Jacobians) -> Array:
        """Return [J_COM, -I], (N, 3, 21)."""
        minus_identity = np.broadcast_to(-np.eye(3), (len(jacobians.com), 3, 3))
        return np.concatenate([jacobians.com, minus_identity], axis=2)


def com_consistency(layout: SampleLayout, weight: float) -> ComConsistency:
    """Return the objective."""
    variables = np.concatenate([layout.pose_indices(), layout.indices("com")], axis=1)
    return ComConsistency(layout, weight, variables)
