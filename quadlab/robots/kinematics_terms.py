"""The arithmetic between Pinocchio's arrays and ``Kinematics``, compiled: on arrays of this size calls cost the most.

Pinocchio's world Jacobian J0 holds the spatial velocity [v at the world origin, omega] that each entry of its velocity
causes. The velocity of a point p follows as v + omega x p; the acceleration of the shank at u_dot = 0 adds up along the
leg, A = sum_i V_i x (J0_i u_i), with V_i the velocity of the body that carries joint i (the base itself adds none).
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from quadlab.geometry.rotations import Array
from quadlab.jit import compiled, compiled_entry

IndexArray: TypeAlias = NDArray[np.intp]

_SIZE = 18
_BASE = 6
_LEG_JOINTS = 3


@compiled
def cross(a: Array, b: Array, result: Array) -> None:
    """Write a x b, all (3,)."""
    result[0] = a[1] * b[2] - a[2] * b[1]
    result[1] = a[2] * b[0] - a[0] * b[2]
    result[2] = a[0] * b[1] - a[1] * b[0]


@compiled
def add_product(matrix: Array, vector: Array, result: Array) -> None:
    """Add matrix @ vector, (m, n) and (n,), to ``result``, (m,)."""
    for row in range(len(result)):
        for column in range(len(vector)):
            result[row] += matrix[row, column] * vector[column]


@compiled_entry
def pinocchio_coordinates(
    position: Array,
    quat_wxyz: Array,
    joints: Array,
    linear_in_world: Array,
    angular_in_base: Array,
    joint_velocities: Array,
    rotation: Array,
    position_indices: IndexArray,
    velocity_indices: IndexArray,
) -> tuple[Array, Array]:
    """Return q (19,) and v (18,) in Pinocchio's order; arguments as in ``RobotState`` and ``PinocchioModel``."""
    q, v = np.empty(_SIZE + 1), np.zeros(_SIZE)
    q[:3] = position
    q[3:6] = quat_wxyz[1:]
    q[6] = quat_wxyz[0]
    add_product(rotation.T, linear_in_world, v[:3])
    v[3:6] = angular_in_base
    for joint in range(len(joints)):
        q[position_indices[joint]] = joints[joint]
        v[velocity_indices[joint]] = joint_velocities[joint]
    return q, v


@compiled_entry
def dynamics_terms(
    mass_matrix: Array, nonlinear_effects: Array, v: Array, order: IndexArray, damping: Array
) -> tuple[Array, Array, Array]:
    """Return u (18,), M (18, 18) and h (18,) in quadlab's order.

    Args:
        mass_matrix, nonlinear_effects, v: of Pinocchio.
        order: u = v[order].
        damping: viscous friction of the joints, (12,).
    """
    u, mass, effects = np.empty(_SIZE), np.empty((_SIZE, _SIZE)), np.empty(_SIZE)
    for row in range(_SIZE):
        u[row] = v[order[row]]
        effects[row] = nonlinear_effects[order[row]]
        if row >= _BASE:
            effects[row] += damping[row - _BASE] * u[row]
        for column in range(_SIZE):
            mass[row, column] = mass_matrix[order[row], order[column]]
    return u, mass, effects


@compiled_entry
def com_terms(
    position: Array,
    velocity: Array,
    jacobian: Array,
    nonlinear_effects: Array,
    rotation: Array,
    gravity: Array,
    mass: float,
    order: IndexArray,
) -> tuple[Array, Array, Array, Array]:
    """Return position (3,), velocity (3,), Jacobian (3, 18) and bias (3,) of the centre of mass.

    The base rows of h are what has to push the robot at u_dot = 0, in base axes: R h_B = m (J_dot u - g).
    """
    bias = gravity.copy()
    for row in range(3):
        for column in range(3):
            bias[row] += rotation[row, column] * nonlinear_effects[column] / mass
    ordered = np.empty((3, _SIZE))
    for row in range(3):
        for column in range(_SIZE):
            ordered[row, column] = jacobian[row, order[column]]
    return position.copy(), velocity.copy(), ordered, bias


@compiled_entry
def base_terms(rotation: Array, v: Array, position: Array, hips_in_base: Array) -> tuple[Array, Array, Array, Array]:
    """Return Jacobian (6, 18) and bias (6,) of the base origin, omega (3,) and the hips (4, 3), all in world axes.

    p_ddot = R (v_dot + omega x v), omega_dot = R omega_B_dot.
    """
    jacobian, bias, omega = np.zeros((6, _SIZE)), np.zeros(6), np.zeros(3)
    jacobian[:3, :3] = rotation
    jacobian[3:, 3:6] = rotation
    centripetal = np.empty(3)
    cross(v[3:6], v[:3], centripetal)
    add_product(rotation, centripetal, bias[:3])
    add_product(rotation, v[3:6], omega)
    hips = np.empty_like(hips_in_base)
    for leg in range(len(hips)):
        hips[leg] = position
        add_product(rotation, hips_in_base[leg], hips[leg])
    return jacobian, bias, omega, hips


@compiled
def _foot_bias(jacobian: Array, v: Array, joints: IndexArray, foot: Array, bias: Array, angular_bias: Array) -> None:
    """Write the linear acceleration of ``foot`` (3,) and the angular one of its shank, both (3,), at u_dot = 0."""
    linear, angular = np.zeros(3), np.zeros(3)  # spatial velocity of the body reached so far
    add_product(jacobian[:3, :_BASE], v[:_BASE], linear)
    add_product(jacobian[3:, :_BASE], v[:_BASE], angular)
    bias[:] = 0.0
    angular_bias[:] = 0.0
    joint_linear, joint_angular, product = np.empty(3), np.empty(3), np.empty(3)
    for joint in joints:
        for axis in range(3):
            joint_linear[axis] = jacobian[axis, joint] * v[joint]
            joint_angular[axis] = jacobian[3 + axis, joint] * v[joint]
        cross(angular, joint_linear, product)
        bias += product
        cross(linear, joint_angular, product)
        bias += product
        cross(angular, joint_angular, product)
        angular_bias += product
        linear += joint_linear
        angular += joint_angular
    cross(angular_bias, foot, product)
    bias += product
    cross(angular, foot, product)  # omega x (v + omega x p): from the spatial to the point's acceleration
    linear += product
    cross(angular, linear, product)
    bias += product


@compiled_entry
def foot_terms(
    jacobian: Array, v: Array, feet: tuple[Array, ...], joints: IndexArray, radius: float
) -> tuple[Array, Array, Array, Array, Array, Array, Array, Array]:
    """Return the terms of the sphere centres and of the contact points below them.

    Args:
        jacobian: J0 of Pinocchio, (6, 18).
        v: Pinocchio's velocity, (18,).
        feet: centres of the foot spheres, four of (3,).
        joints: indices of the joints of each leg in v, (4, 3).
        radius: of the spheres in [m].

    Returns:
        foot_centers, foot_positions, foot_velocities (4, 3), foot_jacobians (4, 3, 18), foot_bias (4, 3),
        contact_jacobians (4, 3, 18), contact_bias (4, 3), leg_joint_axes (4, 3, 3), as in ``Kinematics``.
    """
    legs = len(feet)
    centers, velocities, bias = np.empty((legs, 3)), np.zeros((legs, 3)), np.empty((legs, 3))
    linear, axes = np.zeros((legs, 3, _SIZE)), np.empty((legs, 3, _LEG_JOINTS))
    contact, contact_bias, angular_bias = np.zeros((legs, 3, _SIZE)), np.empty((legs, 3)), np.empty(3)
    column = np.empty(3)
    for leg in range(legs):
        foot = feet[leg]
        centers[leg] = foot
        for index in range(_BASE + _LEG_JOINTS):
            own = index if index < _BASE else _BASE + leg * _LEG_JOINTS + index - _BASE
            source = index if index < _BASE else joints[leg, index - _BASE]
            omega = jacobian[3:, source]
            cross(omega, foot, column)
            column += jacobian[:3, source]
            for axis in range(3):
                linear[leg, axis, own] = column[axis]
                contact[leg, axis, own] = column[axis]
                velocities[leg, axis] += column[axis] * v[source]
                if index >= _BASE:
                    axes[leg, axis, index - _BASE] = omega[axis]
            contact[leg, 0, own] -= radius * omega[1]  # omega x (0, 0, -radius)
            contact[leg, 1, own] += radius * omega[0]
        _foot_bias(jacobian, v, joints[leg], foot, bias[leg], angular_bias)
        contact_bias[leg] = bias[leg]
        contact_bias[leg, 0] -= radius * angular_bias[1]
        contact_bias[leg, 1] += radius * angular_bias[0]
    positions = centers.copy()
    positions[:, 2] -= radius
    return centers, positions, velocities, linear, bias, contact, contact_bias, axes


@compiled_entry
def contact_points(
    jacobian: Array, v: Array, feet: tuple[Array, ...], joints: IndexArray, radius: float
) -> tuple[Array, Array]:
    """Return foot_positions and foot_contact_velocities, (4, 3) each, as in ``MotionPoints``; see ``foot_terms``."""
    legs = len(feet)
    positions, velocities = np.empty((legs, 3)), np.empty((legs, 3))
    linear, angular = np.empty(3), np.empty(3)
    for leg in range(legs):
        positions[leg] = feet[leg]
        positions[leg, 2] -= radius
        linear[:] = 0.0
        angular[:] = 0.0
        add_product(jacobian[:3, :_BASE], v[:_BASE], linear)
        add_product(jacobian[3:, :_BASE], v[:_BASE], angular)
        for joint in joints[leg]:
            for axis in range(3):
                linear[axis] += jacobian[axis, joint] * v[joint]
                angular[axis] += jacobian[3 + axis, joint] * v[joint]
        cross(angular, positions[leg], velocities[leg])
        velocities[leg] += linear
    return positions, velocities
