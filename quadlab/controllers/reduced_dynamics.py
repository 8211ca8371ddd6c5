"""Dynamics and contact eliminated: accelerations and contact forces as affine functions of the torques.

With the contacts held, the equations of motion and Eq. 16 of Bellicoso 2016 (right-hand side -J_dot u),

    [M  -J^T] [u_dot ]   [S^T tau - h]
    [J    0 ] [lambda] = [-J_dot u   ],

give u_dot = U tau + u_0 and lambda = L tau + l_0. A hierarchy whose first levels are the equations of motion and
"no contact motion" has exactly these solutions, so the remaining levels are solved in the 12 torques alone.
"""

from dataclasses import dataclass

import numpy as np

from quadlab.controllers.tasks.task import Variable
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import JOINT_COUNT

_BASE = 6


@dataclass(frozen=True)
class ReducedDynamics:
    """The affine maps from the joint torques tau, (12,) in [N m].

    Attributes:
        acceleration_map, acceleration_offset: U (18, 12) and u_0 (18,).
        force_map, force_offset: L (3 n, 12) and l_0 (3 n,) for n standing legs.
    """

    acceleration_map: Array
    acceleration_offset: Array
    force_map: Array
    force_offset: Array

    def map_of(self, variable: Variable) -> tuple[Array, Array]:
        """Return matrix (n, 12) and offset (n,) that give ``variable`` from the torques."""
        if variable is Variable.ACCELERATION:
            return self.acceleration_map, self.acceleration_offset
        if variable is Variable.FORCE:
            return self.force_map, self.force_offset
        return np.eye(JOINT_COUNT), np.zeros(JOINT_COUNT)

    def accelerations(self, torques: Array) -> Array:
        """Return u_dot, (18,), for ``torques``, (12,) in [N m]."""
        return self.acceleration_map @ torques + self.acceleration_offset

    def forces(self, torques: Array) -> Array:
        """Return lambda, (n, 3) in [N], for ``torques``, (12,) in [N m]."""
        return (self.force_map @ torques + self.force_offset).reshape(-1, 3)


def reduce_dynamics(kinematics: Kinematics, stance_legs: list[int]) -> ReducedDynamics:
    """Eliminate equations of motion and contacts of ``stance_legs`` (numbers in the order of ``LEGS``)."""
    inputs = np.zeros((_BASE + JOINT_COUNT, JOINT_COUNT + 1))
    inputs[_BASE:, :JOINT_COUNT] = np.eye(JOINT_COUNT)
    inputs[:, JOINT_COUNT] = -kinematics.nonlinear_effects
    if not stance_legs:
        free = _solve(kinematics.mass_matrix, inputs)
        return ReducedDynamics(free[:, :-1], free[:, -1], np.zeros((0, JOINT_COUNT)), np.zeros(0))
    jacobian = kinematics.contact_jacobians[stance_legs].reshape(3 * len(stance_legs), -1)
    solved = _solve(kinematics.mass_matrix, np.hstack([inputs, jacobian.T]))
    free_motion, per_force = solved[:, : JOINT_COUNT + 1], solved[:, JOINT_COUNT + 1 :]
    rest = -jacobian @ free_motion
    rest[:, JOINT_COUNT] -= kinematics.contact_bias[stance_legs].ravel()
    forces = _solve(jacobian @ per_force, rest)
    accelerations = free_motion + per_force @ forces
    return ReducedDynamics(accelerations[:, :-1], accelerations[:, -1], forces[:, :-1], forces[:, -1])


def _solve(matrix: Array, right_side: Array) -> Array:
    return np.asarray(np.linalg.solve(matrix, right_side), dtype=np.float64)
