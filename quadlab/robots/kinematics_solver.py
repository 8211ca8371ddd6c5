"""Computes ``Kinematics`` with Pinocchio."""

from typing import Any

import numpy as np
import pinocchio as pin

from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics, MotionPoints
from quadlab.robots.kinematics_terms import (
    base_terms,
    com_terms,
    contact_points,
    dynamics_terms,
    foot_terms,
    pinocchio_coordinates,
)
from quadlab.robots.legs import JOINTS_PER_LEG, LEG_COUNT
from quadlab.robots.pinocchio_model import PinocchioModel
from quadlab.robots.state import RobotState


class KinematicsSolver:
    """Kinematics and dynamics of one robot; owns a Pinocchio workspace, so it must not be shared between threads.

    Pinocchio writes into the same memory at every state. Arrays over that memory are made once and read after each
    call, since asking for them takes longer than the computation.

    Args:
        indexed: the robot's Pinocchio model.
        foot_radius: in [m].
    """

    def __init__(self, indexed: PinocchioModel, foot_radius: float) -> None:
        self._indexed = indexed
        self._model = model = indexed.model
        self._data: Any = model.createData()
        self._foot_radius = foot_radius
        self._joints_of_legs = indexed.velocity_indices.reshape(LEG_COUNT, JOINTS_PER_LEG)
        self._joint_damping = model.damping[indexed.velocity_indices].copy()
        self._gravity = model.gravity.linear.copy()
        self._mass = float(pin.computeTotalMass(model))
        self._hips_in_base = np.array([model.jointPlacements[joint].translation for joint in indexed.hip_joints])
        self._dynamics = (self._data.M, self._data.nle)
        self._com = (self._data.com[0], self._data.vcom[0], self._data.Jcom)
        self._jacobian = self._data.J
        self._feet = tuple(self._data.oMf[frame].translation for frame in indexed.foot_frames)

    def to_pinocchio(self, state: RobotState) -> tuple[Array, Array]:
        """Return configuration q, (19,), and velocity v, (18,), in Pinocchio's order and conventions."""
        return pinocchio_coordinates(
            state.position_base_in_world,
            state.quat_wxyz,
            state.joint_positions,
            state.linear_velocity_base_in_world,
            state.angular_velocity_base_in_base,
            state.joint_velocities,
            state.rotation_base_to_world,
            self._indexed.position_indices,
            self._indexed.velocity_indices,
        )

    def solve(self, state: RobotState) -> Kinematics:
        """Compute kinematics and dynamics at ``state``."""
        order, rotation = self._indexed.order, state.rotation_base_to_world
        q, v = self.to_pinocchio(state)
        pin.computeAllTerms(self._model, self._data, q, v)
        pin.updateFramePlacements(self._model, self._data)
        velocity, mass_matrix, effects = dynamics_terms(*self._dynamics, v, order, self._joint_damping)
        com_position, com_velocity, com_jacobian, com_bias = com_terms(
            *self._com, effects, rotation, self._gravity, self._mass, order
        )
        base_jacobian, base_bias, base_angular_velocity, hips = base_terms(
            rotation, v, state.position_base_in_world, self._hips_in_base
        )
        centers, positions, velocities, jacobians, bias, contact_jacobians, contact_bias, axes = foot_terms(
            self._jacobian, v, self._feet, self._joints_of_legs, self._foot_radius
        )
        return Kinematics(
            generalized_velocity=velocity,
            mass_matrix=mass_matrix,
            nonlinear_effects=effects,
            com_position=com_position,
            com_velocity=com_velocity,
            com_jacobian=com_jacobian,
            com_bias=com_bias,
            base_position=state.position_base_in_world,
            base_rotation=rotation,
            base_linear_velocity=state.linear_velocity_base_in_world,
            base_angular_velocity=base_angular_velocity,
            base_jacobian=base_jacobian,
            base_bias=base_bias,
            foot_centers=centers,
            foot_positions=positions,
            foot_velocities=velocities,
            foot_jacobians=jacobians,
            foot_bias=bias,
            contact_jacobians=contact_jacobians,
            contact_bias=contact_bias,
            joint_positions=state.joint_positions,
            leg_joint_axes=axes,
            hip_positions=hips,
        )

    def points(self, state: RobotState) -> MotionPoints:
        """Compute positions and velocities of centre of mass and feet at ``state``."""
        q, v = self.to_pinocchio(state)
        pin.centerOfMass(self._model, self._data, q, v)
        pin.computeJointJacobians(self._model, self._data)
        pin.updateFramePlacements(self._model, self._data)
        positions, velocities = contact_points(self._jacobian, v, self._feet, self._joints_of_legs, self._foot_radius)
        com_position, com_velocity, _ = self._com
        return MotionPoints(com_position.copy(), com_velocity.copy(), positions, velocities)
