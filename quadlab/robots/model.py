"""A loaded robot: limits, nominal stance, and kinematics and dynamics at any state."""

from functools import cached_property
from typing import Any

import numpy as np
import pinocchio as pin

from quadlab.geometry.rotations import Array, skew
from quadlab.robots.config import RobotConfig
from quadlab.robots.description import load_urdf_text
from quadlab.robots.kinematics import BASE_ANGULAR, BASE_LINEAR, VELOCITY_SIZE, Kinematics
from quadlab.robots.legs import JOINT_COUNT, LEG_COUNT, LEGS
from quadlab.robots.pinocchio_model import build_pinocchio_model
from quadlab.robots.state import RobotState


def load_robot(config: RobotConfig) -> "RobotModel":
    """Load the robot that ``config`` describes.

    Raises:
        RobotDescriptionError: if the description is missing or does not have the named parts.
    """
    return RobotModel(config)


class RobotModel:
    """One robot; every array over joints or legs has the order of ``JOINT_NAMES`` and ``LEGS``.

    An instance owns one Pinocchio workspace, so it must not be shared between threads.

    Attributes:
        config: what the robot was loaded from.
        name: of the robot.
        urdf_text: URDF with overrides, the source of this and of the simulator's model.
        pin_model: ``pinocchio.Model`` with a free-flying base.
        joint_names: what the URDF calls the joints, (12,).
        position_indices: of the joints in Pinocchio's configuration, (12,).
        velocity_indices: of the joints in Pinocchio's velocity, (12,).
        mass: in [kg].
        torque_limits: (12,) in [N m].
        joint_position_limits: lower and upper, (12, 2) in [rad].
        joint_velocity_limits: (12,) in [rad/s].
        joint_damping: viscous friction, (12,) in [N m s/rad].
        nominal_joint_positions: (12,) in [rad].
        foot_radius: in [m].
        reach: half box of foot motion forward and sideways, (2,) in [m].
    """

    def __init__(self, config: RobotConfig) -> None:
        self.config = config
        self.name = config.name
        self.urdf_text = load_urdf_text(config)
        self._indexed = build_pinocchio_model(config, self.urdf_text)
        self.pin_model = self._indexed.model
        self._data: Any = self.pin_model.createData()
        self.joint_names = self._indexed.joint_names
        self.position_indices = self._indexed.position_indices
        self.velocity_indices = self._indexed.velocity_indices
        self._read_constants()

    def _read_constants(self) -> None:
        model, positions, velocities = self.pin_model, self.position_indices, self.velocity_indices
        self.mass = float(pin.computeTotalMass(model))
        self.torque_limits: Array = model.upperEffortLimit[velocities].copy()
        self.joint_velocity_limits: Array = model.upperVelocityLimit[velocities].copy()
        self.joint_position_limits: Array = np.column_stack(
            [model.lowerPositionLimit[positions], model.upperPositionLimit[positions]]
        )
        self.joint_damping: Array = model.damping[velocities].copy()
        self.nominal_joint_positions: Array = np.concatenate([self.config.nominal_joints_rad[leg] for leg in LEGS])
        self.foot_radius = self.config.foot_radius_m
        self.reach: Array = np.array(self.config.reach_m)
        self._mass_matrix_order = np.ix_(self._indexed.order, self._indexed.order)
        self._zero_acceleration: Array = np.zeros(model.nv)
        self._to_contact: Array = np.array([0.0, 0.0, -self.foot_radius])
        self._skew_to_contact = skew(self._to_contact)

    @cached_property
    def _nominal_kinematics(self) -> Kinematics:
        return self.kinematics(self.nominal_state())

    @property
    def nominal_com_height(self) -> float:
        """Height of the centre of mass above the ground in the nominal stance, in [m]."""
        return float(self._nominal_kinematics.com_position[2])

    @property
    def nominal_feet_in_com(self) -> Array:
        """Horizontal foot positions relative to the centre of mass in the nominal stance, (4, 2) in [m]."""
        nominal = self._nominal_kinematics
        return np.asarray(nominal.foot_positions[:, :2] - nominal.com_position[:2])

    def nominal_state(self) -> RobotState:
        """Return the nominal stance at rest: level base above the world's origin, lowest foot on z = 0."""
        state = self._state_at_height(0.0)
        lowest = float(self.kinematics(state).foot_positions[:, 2].min())
        return self._state_at_height(-lowest)

    def _state_at_height(self, height: float) -> RobotState:
        return RobotState(
            time_s=0.0,
            position_base_in_world=np.array([0.0, 0.0, height]),
            quat_wxyz=np.array([1.0, 0.0, 0.0, 0.0]),
            joint_positions=self.nominal_joint_positions.copy(),
            linear_velocity_base_in_world=np.zeros(3),
            angular_velocity_base_in_base=np.zeros(3),
            joint_velocities=np.zeros(JOINT_COUNT),
            foot_forces_in_world=np.zeros((LEG_COUNT, 3)),
        )

    def to_pinocchio(self, state: RobotState) -> tuple[Array, Array]:
        """Return configuration q, (19,), and velocity v, (18,), in Pinocchio's order and conventions."""
        q = np.empty(self.pin_model.nq)
        q[:3] = state.position_base_in_world
        q[3:6] = state.quat_wxyz[1:]
        q[6] = state.quat_wxyz[0]
        q[self.position_indices] = state.joint_positions
        v = np.empty(self.pin_model.nv)
        v[BASE_LINEAR] = state.rotation_base_to_world.T @ state.linear_velocity_base_in_world
        v[BASE_ANGULAR] = state.angular_velocity_base_in_base
        v[self.velocity_indices] = state.joint_velocities
        return q, v

    def kinematics(self, state: RobotState) -> Kinematics:
        """Compute kinematics and dynamics at ``state``."""
        model, data, order = self.pin_model, self._data, self._indexed.order
        q, v = self.to_pinocchio(state)
        pin.computeAllTerms(model, data, q, v)
        mass_matrix = data.M[self._mass_matrix_order]
        nonlinear_effects = data.nle[order]
        nonlinear_effects[6:] += self.joint_damping * state.joint_velocities
        com_jacobian = data.Jcom[:, order]
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
            hip_positions=np.array([data.oMi[joint].translation for joint in self._indexed.hip_joints]),
            **_base_terms(rotation, v),
            **self._foot_terms(v[order]),
        )

    def _foot_terms(self, velocity: Array) -> dict[str, Array]:
        """Terms of the sphere centres and of the contact points, at r = (0, 0, -radius) from them in world axes."""
        centers = np.empty((LEG_COUNT, 3))
        jacobians = np.empty((LEG_COUNT, 6, VELOCITY_SIZE))
        accelerations = np.empty((LEG_COUNT, 6))
        for leg, frame in enumerate(self._indexed.foot_frames):
            centers[leg] = self._data.oMf[frame].translation
            world_axes = pin.LOCAL_WORLD_ALIGNED
            jacobians[leg] = pin.getFrameJacobian(self.pin_model, self._data, frame, world_axes)[:, self._indexed.order]
            accelerations[leg] = pin.getFrameClassicalAcceleration(self.pin_model, self._data, frame, world_axes).vector
        linear, angular = jacobians[:, :3], jacobians[:, 3:]
        return {
            "foot_centers": centers,
            "foot_positions": centers + self._to_contact,
            "foot_velocities": linear @ velocity,
            "foot_jacobians": linear,
            "foot_bias": accelerations[:, :3],
            "contact_jacobians": linear - self._skew_to_contact @ angular,
            "contact_bias": accelerations[:, :3] - accelerations[:, 3:] @ self._skew_to_contact.T,
        }


def _base_terms(rotation: Array, velocity: Array) -> dict[str, Array]:
    """Jacobian and bias of the base origin: p_ddot = R (v_dot + omega x v), omega_dot = R omega_B_dot."""
    jacobian = np.zeros((6, VELOCITY_SIZE))
    jacobian[:3, BASE_LINEAR] = rotation
    jacobian[3:, BASE_ANGULAR] = rotation
    bias = np.zeros(6)
    bias[:3] = rotation @ (skew(velocity[BASE_ANGULAR]) @ velocity[BASE_LINEAR])
    return {"base_jacobian": jacobian, "base_bias": bias}
