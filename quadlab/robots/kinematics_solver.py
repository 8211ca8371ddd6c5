"""Computes ``Kinematics`` with Pinocchio."""

from typing import Any

import numpy as np
import pinocchio as pin

from quadlab.geometry.rotations import Array, skew
from quadlab.robots.kinematics import BASE, BASE_ANGULAR, BASE_LINEAR, JOINTS, VELOCITY_SIZE, Kinematics
from quadlab.robots.legs import LEG_COUNT, joints_of
from quadlab.robots.pinocchio_model import PinocchioModel
from quadlab.robots.state import RobotState

_LEGS = np.arange(LEG_COUNT)[:, None]
_JOINTS_OF_LEGS = np.array([np.arange(VELOCITY_SIZE)[JOINTS][joints_of(leg)] for leg in range(LEG_COUNT)])
"""Indices of the joints of each leg in the generalised velocity, (4, 3)."""


class KinematicsSolver:
    """Kinematics and dynamics of one robot; owns a Pinocchio workspace, so it must not be shared between threads.

    Args:
        indexed: the robot's Pinocchio model.
        foot_radius: in [m].
    """

    def __init__(self, indexed: PinocchioModel, foot_radius: float) -> None:
        self._indexed = indexed
        self._model = indexed.model
        self._data: Any = self._model.createData()
        self._joint_damping = self._model.damping[indexed.velocity_indices].copy()
        self._mass_matrix_order = np.ix_(indexed.order, indexed.order)
        self._zero_acceleration = np.zeros(self._model.nv)
        self._foot_radius = foot_radius
        self._to_contact = np.array([0.0, 0.0, -foot_radius])
        self._skew_to_contact = skew(self._to_contact)

    def to_pinocchio(self, state: RobotState) -> tuple[Array, Array]:
        """Return configuration q, (19,), and velocity v, (18,), in Pinocchio's order and conventions."""
        q = np.empty(self._model.nq)
        q[:3] = state.position_base_in_world
        q[3:6] = state.quat_wxyz[1:]
        q[6] = state.quat_wxyz[0]
        q[self._indexed.position_indices] = state.joint_positions
        v = np.empty(self._model.nv)
        v[BASE_LINEAR] = state.rotation_base_to_world.T @ state.linear_velocity_base_in_world
        v[BASE_ANGULAR] = state.angular_velocity_base_in_base
        v[self._indexed.velocity_indices] = state.joint_velocities
        return q, v

    def solve(self, state: RobotState) -> Kinematics:
        """Compute kinematics and dynamics at ``state``."""
        model, data, order = self._model, self._data, self._indexed.order
        q, v = self.to_pinocchio(state)
        pin.computeAllTerms(model, data, q, v)
        mass_matrix = data.M[self._mass_matrix_order]
        nonlinear_effects = data.nle[order]
        nonlinear_effects[JOINTS] += self._joint_damping * state.joint_velocities
        com_jacobian = data.Jcom[:, order]
        # Accelerations with u_dot = 0 are the bias terms.
        pin.forwardKinematics(model, data, q, v, self._zero_acceleration)
        pin.updateFramePlacements(model, data)
        pin.centerOfMass(model, data, pin.KinematicLevel.ACCELERATION, False)
        rotation = state.rotation_base_to_world
        return Kinematics(
            generalized_velocity=v[order],
            mass_matrix=mass_matrix,
            nonlinear_effects=nonlinear_effects,
            com_position=data.com[0].copy(),
            com_velocity=data.vcom[0].copy(),
            com_jacobian=com_jacobian,
            com_bias=data.acom[0].copy(),
            base_position=state.position_base_in_world,
            base_rotation=rotation,
            base_linear_velocity=state.linear_velocity_base_in_world,
            base_angular_velocity=rotation @ state.angular_velocity_base_in_base,
            joint_positions=state.joint_positions,
            hip_positions=np.array([data.oMi[joint].translation for joint in self._indexed.hip_joints]),
            **_base_terms(rotation, v),
            **self._foot_terms(v[order]),
        )

    def _foot_terms(self, velocity: Array) -> dict[str, Array]:
        """Terms of the sphere centres and of the contact points, at r = (0, 0, -radius) from them in world axes."""
        model, data, axes = self._model, self._data, pin.LOCAL_WORLD_ALIGNED
        centers = np.empty((LEG_COUNT, 3))
        raw_jacobians = np.empty((LEG_COUNT, 6, VELOCITY_SIZE))
        accelerations = np.empty((LEG_COUNT, 6))
        for leg, frame in enumerate(self._indexed.foot_frames):
            centers[leg] = data.oMf[frame].translation
            raw_jacobians[leg] = pin.getFrameJacobian(model, data, frame, axes)
            accelerations[leg] = pin.getFrameClassicalAcceleration(model, data, frame, axes).vector
        jacobians = raw_jacobians.take(self._indexed.order, axis=2)
        linear, angular = jacobians[:, :3], jacobians[:, 3:]
        contact_jacobians = linear.copy()  # J - skew(r) J_angular, entry by entry
        contact_jacobians[:, 0] -= self._foot_radius * angular[:, 1]
        contact_jacobians[:, 1] += self._foot_radius * angular[:, 0]
        return {
            "leg_joint_axes": angular[_LEGS, :, _JOINTS_OF_LEGS].transpose(0, 2, 1),
            "foot_centers": centers,
            "foot_positions": centers + self._to_contact,
            "foot_velocities": linear @ velocity,
            "foot_jacobians": linear,
            "foot_bias": accelerations[:, :3],
            "contact_jacobians": contact_jacobians,
            "contact_bias": accelerations[:, :3] - accelerations[:, 3:] @ self._skew_to_contact.T,
        }


def _base_terms(rotation: Array, velocity: Array) -> dict[str, Array]:
    """Jacobian and bias of the base origin: p_ddot = R (v_dot + omega x v), omega_dot = R omega_B_dot."""
    jacobian = np.zeros((6, VELOCITY_SIZE))
    jacobian[:3, BASE_LINEAR] = rotation
    jacobian[3:, BASE_ANGULAR] = rotation
    vx, vy, vz, wx, wy, wz = velocity[BASE].tolist()
    bias = np.zeros(6)
    bias[:3] = rotation @ np.array([wy * vz - wz * vy, wz * vx - wx * vz, wx * vy - wy * vx])
    return {"base_jacobian": jacobian, "base_bias": bias}
