"""Kinematics and dynamics of a robot at one state, in quadlab's order and conventions."""

from typing import NamedTuple

from quadlab.geometry.rotations import Array

VELOCITY_SIZE = 18
"""Size of the generalised velocity: 6 of the base and 12 joints."""

BASE_LINEAR = slice(0, 3)
BASE_ANGULAR = slice(3, 6)
BASE = slice(0, 6)
JOINTS = slice(6, 18)
"""Blocks of the generalised velocity u = [v_B, omega_B, joint velocities]."""


class Kinematics(NamedTuple):
    """Certifies that kinematics and dynamics were computed for one state; made by ``RobotModel.kinematics``.

    A named tuple, since it is made in every tick and takes a quarter of the time of a frozen dataclass.

    The generalised velocity is u = [velocity of the base origin in base axes (3), angular velocity of the base in
    base axes (3), joint velocities in the order ``JOINT_NAMES`` (12)]. Positions, Jacobians and bias terms are in
    world axes; a point's acceleration is J u_dot + bias. The equation of motion is

        M u_dot + h = S^T tau + sum_i J_ci^T lambda_i

    with the contact Jacobians J_ci and the forces lambda_i of the ground on the feet.

    Attributes:
        generalized_velocity: u, (18,) in [m/s] and [rad/s].
        mass_matrix: M, (18, 18).
        nonlinear_effects: h, (18,): gravity, Coriolis and centrifugal terms and the joints' viscous friction.
        com_position, com_velocity: centre of mass, (3,) in [m], [m/s].
        com_jacobian: (3, 18).
        com_bias: J_dot u of the centre of mass, (3,) in [m/s^2].
        base_position: base origin, (3,) in [m].
        base_rotation: base to world, (3, 3).
        base_linear_velocity: velocity of the base origin, (3,) in [m/s].
        base_angular_velocity: (3,) in [rad/s].
        base_jacobian: linear rows above angular rows, (6, 18).
        base_bias: (6,) in [m/s^2] and [rad/s^2].
        foot_centers: centres of the foot spheres, (4, 3) in [m].
        foot_positions: lowest points of the foot spheres, where level ground touches them, (4, 3) in [m].
        foot_velocities: of the sphere centres, (4, 3) in [m/s].
        foot_jacobians: of the sphere centres, (4, 3, 18).
        foot_bias: of the sphere centres, (4, 3) in [m/s^2].
        contact_jacobians: of the material points of the feet at ``foot_positions``, (4, 3, 18).
        contact_bias: J_dot u of these Jacobians, (4, 3) in [m/s^2]. The lowest point of a rolling sphere wanders
            over its surface: J u_dot + J_dot u = 0 keeps the foot rolling without slip, and for that reason the
            bias has no centripetal term towards the sphere's centre.
        joint_positions: (12,) in [rad], order ``JOINT_NAMES``.
        leg_joint_axes: axes of HAA, HFE and KFE as columns for each leg, (4, 3, 3).
        hip_positions: origins of the HAA joints, (4, 3) in [m].
    """

    generalized_velocity: Array
    mass_matrix: Array
    nonlinear_effects: Array
    com_position: Array
    com_velocity: Array
    com_jacobian: Array
    com_bias: Array
    base_position: Array
    base_rotation: Array
    base_linear_velocity: Array
    base_angular_velocity: Array
    base_jacobian: Array
    base_bias: Array
    foot_centers: Array
    foot_positions: Array
    foot_velocities: Array
    foot_jacobians: Array
    foot_bias: Array
    contact_jacobians: Array
    contact_bias: Array
    joint_positions: Array
    leg_joint_axes: Array
    hip_positions: Array


class MotionPoints(NamedTuple):
    """The part of ``Kinematics`` that takes no dynamics, for callers that need no more.

    Attributes:
        com_position, com_velocity: centre of mass, (3,) in [m], [m/s].
        foot_positions: lowest points of the foot spheres, (4, 3) in [m].
        foot_contact_velocities: of the material points of the feet there, (4, 3) in [m/s].
    """

    com_position: Array
    com_velocity: Array
    foot_positions: Array
    foot_contact_velocities: Array
