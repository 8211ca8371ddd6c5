"""A loaded robot: limits, nominal stance, and kinematics and dynamics at any state."""

from functools import cached_property

import numpy as np
import pinocchio as pin

from quadlab.errors import RobotDescriptionError
from quadlab.geometry.rotations import Array
from quadlab.robots.config import RobotConfig
from quadlab.robots.description import load_urdf_text
from quadlab.robots.kinematics import Kinematics, MotionPoints
from quadlab.robots.kinematics_solver import KinematicsSolver
from quadlab.robots.legs import JOINT_COUNT, JOINT_NAMES, LEG_COUNT, LEGS
from quadlab.robots.pinocchio_model import build_pinocchio_model
from quadlab.robots.state import RobotState


def load_robot(config: RobotConfig) -> "RobotModel":
    """Load the robot that ``config`` describes.

    Raises:
        RobotDescriptionError: if the description is missing, does not have the named parts, or its joints do not reach
            the nominal stance.
    """
    return RobotModel(config)


class RobotModel:
    """One robot; every array over joints or legs has the order of ``JOINT_NAMES`` and ``LEGS``.

    An instance owns a Pinocchio workspace, so it must not be shared between threads.

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
        indexed = build_pinocchio_model(config, self.urdf_text)
        self._solver = KinematicsSolver(indexed, config.foot_radius_m)
        self.pin_model = indexed.model
        self.joint_names = indexed.joint_names
        self.position_indices = indexed.position_indices
        self.velocity_indices = indexed.velocity_indices
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
        self._check_nominal_joints()
        self.foot_radius = self.config.foot_radius_m
        self.reach: Array = np.array(self.config.reach_m)

    def _check_nominal_joints(self) -> None:
        for name, angle, (lower, upper) in zip(
            JOINT_NAMES, self.nominal_joint_positions, self.joint_position_limits, strict=True
        ):
            if not lower <= angle <= upper:
                raise RobotDescriptionError(
                    f"robot {self.name}: nominal_joints_rad: {name} at {angle:g} rad is outside its range of "
                    f"{lower:g} to {upper:g} rad"
                )

    @cached_property
    def _nominal_kinematics(self) -> Kinematics:
        return self.kinematics(self.nominal_state())

    @property
    def nominal_com_height(self) -> float:
        """Height of the centre of mass above the ground in the nominal stance, in [m]."""
        return float(self._nominal_kinematics.com_position[2])

    @property
    def nominal_com_in_base(self) -> Array:
        """Centre of mass relative to the base origin in the nominal stance, (3,) in [m]."""
        nominal = self._nominal_kinematics
        return np.asarray(nominal.com_position - nominal.base_position)

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
        return self._solver.to_pinocchio(state)

    def kinematics(self, state: RobotState) -> Kinematics:
        """Compute kinematics and dynamics at ``state``."""
        return self._solver.solve(state)

    def points(self, state: RobotState) -> MotionPoints:
        """Compute the centre of mass and the feet at ``state``, in a fraction of the time of ``kinematics``."""
        return self._solver.points(state)
