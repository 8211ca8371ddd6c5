"""Computes ``Kinematics`` with Pinocchio."""

from typing import Any

import numpy as np
import pinocchio as pin

from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics, MotionPoints
from quadlab.robots.kinematics_terms import (
    Constants,
    Workspace,
    contact_points,
    empty_coordinates,
    empty_terms,
    write_coordinates,
    write_terms,
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
        self._com = (self._data.com[0], self._data.vcom[0], self._data.Jcom)
        self._jacobian = self._data.J
        self._feet = tuple(self._data.oMf[frame].translation for frame in indexed.foot_frames)
        self._coordinates = empty_coordinates()
        self._workspace: Workspace = (self._data.M, self._data.nle, self._com, self._jacobian, self._feet)
        self._constants: Constants = (
            indexed.order,
            model.damping[indexed.velocity_indices].copy(),
            model.gravity.linear.copy(),
            float(pin.computeTotalMass(model)),
            np.array([model.jointPlacements[joint].translation for joint in indexed.hip_joints]),
            self._joints_of_legs,
            foot_radius,
        )

    def to_pinocchio(self, state: RobotState) -> tuple[Array, Array]:
        """Return configuration q, (19,), and velocity v, (18,), in Pinocchio's order and conventions."""
        coordinates = empty_coordinates()
        self._write_coordinates(state, coordinates)
        return coordinates

    def _write_coordinates(self, state: RobotState, coordinates: tuple[Array, Array]) -> None:
        write_coordinates(
            (state.position_base_in_world, state.quat_wxyz, state.joint_positions),
            (state.linear_velocity_base_in_world, state.angular_velocity_base_in_base, state.joint_velocities),
            state.rotation_base_to_world,
            (self._indexed.position_indices, self._indexed.velocity_indices),
            coordinates,
        )

    def solve(self, state: RobotState) -> Kinematics:
        """Compute kinematics and dynamics at ``state``."""
        rotation, position = state.rotation_base_to_world, state.position_base_in_world
        q, v = self._coordinates
        self._write_coordinates(state, self._coordinates)
        pin.computeAllTerms(self._model, self._data, q, v)
        pin.updateFramePlacements(self._model, self._data)
        dynamics, com, base, feet = terms = empty_terms()
        write_terms(self._workspace, self._constants, v, position, rotation, terms)
        return Kinematics(
            generalized_velocity=dynamics[0],
            mass_matrix=dynamics[1],
            nonlinear_effects=dynamics[2],
            com_position=com[0],
            com_velocity=com[1],
            com_jacobian=com[2],
            com_bias=com[3],
            base_position=position,
            base_rotation=rotation,
            base_linear_velocity=state.linear_velocity_base_in_world,
            base_angular_velocity=base[0],
            base_jacobian=base[1],
            base_bias=base[2],
            foot_centers=feet[0],
            foot_positions=feet[1],
            foot_velocities=feet[2],
            foot_jacobians=feet[3],
            foot_bias=feet[4],
            contact_jacobians=feet[5],
            contact_bias=feet[6],
            joint_positions=state.joint_positions,
            leg_joint_axes=feet[7],
            hip_positions=base[3],
        )

    def points(self, state: RobotState) -> MotionPoints:
        """Compute positions and velocities of centre of mass and feet at ``state``."""
        q, v = self._coordinates
        self._write_coordinates(state, self._coordinates)
        pin.centerOfMass(self._model, self._data, q, v)
        pin.computeJointJacobians(self._model, self._data)
        pin.updateFramePlacements(self._model, self._data)
        positions, velocities = contact_points(self._jacobian, v, self._feet, self._joints_of_legs, self._foot_radius)
        com_position, com_velocity, _ = self._com
        return MotionPoints(com_position.copy(), com_velocity.copy(), positions, velocities)
