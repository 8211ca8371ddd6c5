"""Dynamics and contact eliminated: accelerations and contact forces as affine functions of the torques.

With the contacts held, the equations of motion and Eq. 16 of Bellicoso 2016 (right-hand side -J_dot u),

    [M  -J^T] [u_dot ]   [S^T tau - h]
    [J    0 ] [lambda] = [-J_dot u   ],

give u_dot = U tau + u_0 and lambda = L tau + l_0. A hierarchy whose first levels are the equations of motion and
"no contact motion" has exactly these solutions, so the remaining levels are solved in the 12 torques alone.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from quadlab.controllers.decision_space import DecisionSpace
from quadlab.geometry import cholesky
from quadlab.geometry.cholesky import factorise, solve_factor, solve_transposed_factor
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry, source_fingerprint
from quadlab.robots.kinematics import VELOCITY_SIZE, Kinematics
from quadlab.robots.legs import JOINT_COUNT
from quadlab.robots.pinocchio_model import IndexArray

_BASE = VELOCITY_SIZE - JOINT_COUNT
_COLUMNS = JOINT_COUNT + 1


def reduce_dynamics(kinematics: Kinematics, stance_legs: list[int]) -> DecisionSpace:
    """Eliminate equations of motion and contacts of ``stance_legs`` (numbers in the order of ``LEGS``)."""
    size = VELOCITY_SIZE + JOINT_COUNT + 3 * len(stance_legs)
    space = DecisionSpace(np.empty((size, JOINT_COUNT)), np.empty(size))
    _reduce(
        kinematics.mass_matrix,
        kinematics.nonlinear_effects,
        kinematics.contact_jacobians,
        kinematics.contact_bias,
        np.array(stance_legs, dtype=np.intp),
        space.linear,
        space.offset,
    )
    return space


def _compile_reduction(fingerprint: int) -> Callable[..., None]:
    @compiled_entry
    def reduce(
        mass_matrix: Array,
        nonlinear_effects: Array,
        jacobians: Array,
        biases: Array,
        legs: IndexArray,
        linear: Array,
        offset: Array,
    ) -> None:
        """Write [U; I; L], (30 + m, 12), to ``linear`` and [u_0; 0; l_0], (30 + m,), to ``offset``.

        By Cholesky factors of M = G G^T and J M^-1 J^T = Y^T Y with Y = G^-1 J^T.
        Written out: on matrices of this size the calls of a library take longer than the arithmetic.
        """
        _ = fingerprint  # a closure variable, so that the cached machine code follows a change of the factorisation
        size, contacts = VELOCITY_SIZE, 3 * len(legs)
        factor = mass_matrix.copy()
        factorise(factor)
        half = np.zeros((size, _COLUMNS + contacts))  # G^-1 [S^T, -h, J^T]
        for i in range(size):
            if i >= _BASE:
                half[i, i - _BASE] = 1.0
            half[i, JOINT_COUNT] = -nonlinear_effects[i]
            for c in range(contacts):
                half[i, _COLUMNS + c] = jacobians[legs[c // 3], c % 3, i]
        solve_factor(factor, half)
        delassus, forces = np.zeros((contacts, contacts)), np.zeros((contacts, _COLUMNS))
        for k in range(size):
            for i in range(contacts):
                weight = half[k, _COLUMNS + i]
                for c in range(_COLUMNS):
                    forces[i, c] -= weight * half[k, c]
                for c in range(i + 1):
                    delassus[i, c] += weight * half[k, _COLUMNS + c]
        for i in range(contacts):
            forces[i, JOINT_COUNT] -= biases[legs[i // 3], i % 3]
        factorise(delassus)
        solve_factor(delassus, forces)
        solve_transposed_factor(delassus, forces)
        motion = half[:, :_COLUMNS].copy()
        for i in range(size):
            for k in range(contacts):
                for c in range(_COLUMNS):
                    motion[i, c] += half[i, _COLUMNS + k] * forces[k, c]
        solve_transposed_factor(factor, motion)
        linear[:], offset[:] = 0.0, 0.0
        linear[:size], offset[:size] = motion[:, :JOINT_COUNT], motion[:, JOINT_COUNT]
        for joint in range(JOINT_COUNT):
            linear[size + joint, joint] = 1.0
        linear[size + JOINT_COUNT :], offset[size + JOINT_COUNT :] = forces[:, :JOINT_COUNT], forces[:, JOINT_COUNT]

    return reduce


_reduce = _compile_reduction(source_fingerprint(Path(cholesky.__file__).parent))
