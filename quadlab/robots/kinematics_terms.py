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

DynamicsTerms: TypeAlias = tuple[Array, Array, Array]
"""generalized_velocity, mass_matrix, nonlinear_effects."""
ComTerms: TypeAlias = tuple[Array, Array, Array, Array]
"""com_position, com_velocity, com_jacobian, com_bias."""
BaseTerms: TypeAlias = tuple[Array, Array, Array, Array]
"""base_angular_velocity, base_jacobian, base_bias, hip_positions."""
FootTerms: TypeAlias = tuple[Array, Array, Array, Array, Array, Array, Array, Array]
"""foot_centers, foot_positions, foot_velocities, foot_jacobians, foot_bias, contact_jacobians, contact_bias, axes."""
Workspace: TypeAlias = tuple[Array, Array, tuple[Array, Array, Array], Array, tuple[Array, ...]]
"""Pinocchio's M, nle, (com, vcom, Jcom), J0 and the centres of the foot spheres."""
Constants: TypeAlias = tuple[IndexArray, Array, Array, float, Array, IndexArray, float]
"""Order of u in v, joint damping, gravity, mass, hips in base axes, joints of the legs in v, foot radius."""

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
def write_coordinates(
    pose: tuple[Array, Array, Array],
    velocities: tuple[Array, Array, Array],
    rotation: Array,
    indices: tuple[IndexArray, IndexArray],
    coordinates: tuple[Array, Array],
) -> None:
    """Write q (19,) and v (18,) in Pinocchio's order.

    Args:
        pose: position, quaternion wxyz and joint positions of a ``RobotState``.
        velocities: of the base, linear in world and angular in base axes, and of the joints.
        rotation: base to world, (3, 3).
        indices: of the joints in q and in v, (12,) each.
        coordinates: q and v.
    """
    position, quat_wxyz, joints = pose
    linear_in_world, angular_in_base, joint_velocities = velocities
    position_indices, velocity_indices = indices
    q, v = coordinates
    v[:] = 0.0
    q[:3] = position
    q[3:6] = quat_wxyz[1:]
    q[6] = quat_wxyz[0]
    add_product(rotation.T, linear_in_world, v[:3])
    v[3:6] = angular_in_base
    for joint in range(len(joints)):
        q[position_indices[joint]] = joints[joint]
        v[velocity_indices[joint]] = joint_velocities[joint]


@compiled
def _write_dynamics(
    mass_matrix: Array, nonlinear_effects: Array, v: Array, order: IndexArray, damping: Array, result: DynamicsTerms
) -> None:
    """Write u (18,), M (18, 18) and h (18,) in quadlab's order, u = v[order]."""
    u, mass, effects = result
    for row in range(_SIZE):
        u[row] = v[order[row]]
        effects[row] = nonlinear_effects[order[row]]
        if row >= _BASE:
            effects[row] += damping[row - _BASE] * u[row]
        for column in range(_SIZE):
            mass[row, column] = mass_matrix[order[row], order[column]]


@compiled
def _write_com(
    com: tuple[Array, Array, Array],
    effects: Array,
    rotation: Array,
    gravity: Array,
    mass: float,
    order: IndexArray,
    result: ComTerms,
) -> None:
    """Write position (3,), velocity (3,), Jacobian (3, 18) and bias (3,) of the centre of mass.

    The base rows of h are what has to push the robot at u_dot = 0, in base axes: R h_B = m (J_dot u - g).
    """
    position, velocity, jacobian, bias = result
    position[:] = com[0]
    velocity[:] = com[1]
    bias[:] = gravity
    for row in range(3):
        for column in range(3):
            bias[row] += rotation[row, column] * effects[column] / mass
    for row in range(3):
        for column in range(_SIZE):
            jacobian[row, column] = com[2][row, order[column]]


@compiled
def _write_base(rotation: Array, v: Array, position: Array, hips_in_base: Array, result: BaseTerms) -> None:
    """Write omega (3,), Jacobian (6, 18) and bias (6,) of the base origin and the hips (4, 3), all in world axes.

    p_ddot = R (v_dot + omega x v), omega_dot = R omega_B_dot.
    """
    omega, jacobian, bias, hips = result
    jacobian[:] = 0.0
    jacobian[:3, :3] = rotation
    jacobian[3:, 3:6] = rotation
    omega[:] = 0.0
    bias[:] = 0.0
    centripetal = np.empty(3)
    cross(v[3:6], v[:3], centripetal)
    add_product(rotation, centripetal, bias[:3])
    add_product(rotation, v[3:6], omega)
    for leg in range(len(hips)):
        hips[leg] = position
        add_product(rotation, hips_in_base[leg], hips[leg])


@compiled
def _foot_bias(
    jacobian: Array, v: Array, joints: IndexArray, foot: Array, bias: Array, angular_bias: Array, scratch: Array
) -> None:
    """Write the linear acceleration of ``foot`` (3,) and the angular one of its shank, both (3,), at u_dot = 0.

    ``scratch`` is (5, 3): asking for memory leg by leg takes longer than the arithmetic.
    """
    scratch[:] = 0.0
    linear, angular = scratch[0], scratch[1]  # spatial velocity of the body reached so far
    joint_linear, joint_angular, product = scratch[2], scratch[3], scratch[4]
    add_product(jacobian[:3, :_BASE], v[:_BASE], linear)
    add_product(jacobian[3:, :_BASE], v[:_BASE], angular)
    bias[:] = 0.0
    angular_bias[:] = 0.0
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


@compiled
def _write_feet(
    jacobian: Array, v: Array, feet: tuple[Array, ...], joints: IndexArray, radius: float, result: FootTerms
) -> None:
    """Write the terms of the sphere centres and of the contact points below them.

    Args:
        jacobian: J0 of Pinocchio, (6, 18).
        v: Pinocchio's velocity, (18,).
        feet: centres of the foot spheres, four of (3,).
        joints: indices of the joints of each leg in v, (4, 3).
        radius: of the spheres in [m].
        result: foot_centers, foot_positions, foot_velocities (4, 3), foot_jacobians (4, 3, 18), foot_bias (4, 3),
            contact_jacobians (4, 3, 18), contact_bias (4, 3), leg_joint_axes (4, 3, 3), as in ``Kinematics``.
    """
    centers, positions, velocities, linear, bias, contact, contact_bias, axes = result
    velocities[:] = 0.0
    linear[:] = 0.0
    contact[:] = 0.0
    angular_bias, column, scratch = np.empty(3), np.empty(3), np.empty((5, 3))
    for leg in range(len(feet)):
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
        _foot_bias(jacobian, v, joints[leg], foot, bias[leg], angular_bias, scratch)
        contact_bias[leg] = bias[leg]
        contact_bias[leg, 0] -= radius * angular_bias[1]
        contact_bias[leg, 1] += radius * angular_bias[0]
        positions[leg] = foot
        positions[leg, 2] -= radius


@compiled_entry
def write_terms(
    workspace: Workspace,
    constants: Constants,
    v: Array,
    position: Array,
    rotation: Array,
    result: tuple[DynamicsTerms, ComTerms, BaseTerms, FootTerms],
) -> None:
    """Write all terms of ``Kinematics`` that do not stand in the state already.

    Arrays to write to are an argument, since every array that a compiled function returns costs more than its numbers.

    Args:
        workspace: of Pinocchio, computed for this state.
        constants: of the robot.
        v: Pinocchio's velocity, (18,).
        position, rotation: of the base, (3,) in [m] and (3, 3).
        result: arrays from ``empty_terms``.
    """
    mass_matrix, nonlinear_effects, com, jacobian, feet = workspace
    order, damping, gravity, mass, hips_in_base, joints, radius = constants
    dynamics, of_com, of_base, of_feet = result
    _write_dynamics(mass_matrix, nonlinear_effects, v, order, damping, dynamics)
    _write_com(com, dynamics[2], rotation, gravity, mass, order, of_com)
    _write_base(rotation, v, position, hips_in_base, of_base)
    _write_feet(jacobian, v, feet, joints, radius, of_feet)


def empty_coordinates() -> tuple[Array, Array]:
    """Return arrays for ``write_coordinates``; their numbers are arbitrary."""
    return np.empty(_SIZE + 1), np.empty(_SIZE)


def empty_terms() -> tuple[DynamicsTerms, ComTerms, BaseTerms, FootTerms]:
    """Return arrays for ``write_terms``; their numbers are arbitrary."""
    empty, point, points, jacobians = np.empty, 3, (4, 3), (4, 3, _SIZE)
    return (
        (empty(_SIZE), empty((_SIZE, _SIZE)), empty(_SIZE)),
        (empty(point), empty(point), empty((3, _SIZE)), empty(point)),
        (empty(point), empty((6, _SIZE)), empty(6), empty(points)),
        (
            *(empty(points), empty(points), empty(points), empty(jacobians), empty(points)),
            *(empty(jacobians), empty(points), empty((4, 3, _LEG_JOINTS))),
        ),
    )


@compiled_entry
def contact_points(
    jacobian: Array, v: Array, feet: tuple[Array, ...], joints: IndexArray, radius: float
) -> tuple[Array, Array]:
    """Return foot_positions and foot_contact_velocities, (4, 3) each, as in ``MotionPoints``; see ``_write_feet``."""
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
