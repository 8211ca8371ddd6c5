"""Eq. (3), second line: the auxiliary feet are the feet of the configuration, at the height of ground or swing."""

from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.kinematics import LEG_POSE_COLUMNS
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import Coordinates, Jacobians
from quadlab.robots.legs import LEG_COUNT
from quadlab.robots.pinocchio_model import IndexArray


@dataclass(frozen=True)
class FeetConsistency:
    """Residual r_EE,k(q_i) - e_{k,i} of every sample and leg; the height of e_k is given.

    Attributes:
        layout: of p.
        weight: in [1/m^2].
        heights: of the contact points, (N, 4) in [m].
        variables: base, joints of the leg and e_k, (4 N, 11).
    """

    layout: SampleLayout
    weight: float
    heights: Array
    variables: IndexArray
    name: str = "feet_consistency"

    def residual(self, p: Array, coordinates: Coordinates) -> Array:
        """Return r_EE,k(q_i) - e_{k,i}, (4 N, 3) in [m]."""
        planned = np.concatenate([self.layout.feet(p), self.heights[:, :, None]], axis=2)
        difference: Array = coordinates.feet - planned
        return difference.reshape(-1, 3)

    def jacobian(self, p: Array, jacobians: Jacobians) -> Array:
        """Return [J_EE,k, -I], (4 N, 3, 11)."""
        kinematic = jacobians.feet.reshape(-1, 3, jacobians.feet.shape[3])
        minus_identity = np.broadcast_to(-np.eye(3)[:, :2], (len(kinematic), 3, 2))
        return np.concatenate([kinematic, minus_identity], axis=2)


def feet_consistency(layout: SampleLayout, heights: Array, weight: float) -> FeetConsistency:
    """Return the objective.

    Args:
        layout: of p.
        heights: of the contact points, (N, 4) in [m].
        weight: in [1/m^2].
    """
    poses = layout.pose_indices()[:, LEG_POSE_COLUMNS]
    variables = np.concatenate([poses, layout.foot_indices()], axis=2)
    return FeetConsistency(layout, weight, heights, variables.reshape(layout.samples * LEG_COUNT, -1))
