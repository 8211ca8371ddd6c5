"""The legs as the base sees them: where the feet are, how they move, what force they feel."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin

from quadlab.geometry.rotations import Array
from quadlab.robots.legs import JOINT_COUNT, LEG_COUNT, joints_of
from quadlab.robots.model import RobotModel
from quadlab.robots.pinocchio_model import foot_links_in_urdf
from quadlab.robots.sensing import SensorReading


@dataclass(frozen=True)
class LegKinematics:
    """Feet relative to the base, in base axes.

    Attributes:
        foot_centers: centres of the foot spheres, (4, 3) in [m].
        jacobians: of the centres by the joints of the leg, (4, 3, 3).
        foot_spins: angular velocity of each foot relative to the base, (4, 3) in [rad/s].
    """

    foot_centers: Array
    jacobians: Array
    foot_spins: Array


class LegModel:
    """Kinematics and dynamics of the legs under a base that is held at the origin.

    An instance owns a Pinocchio workspace, so it must not be shared between threads.
    """

    def __init__(self, robot: RobotModel) -> None:
        self._robot = robot
        self._model: Any = robot.pin_model
        self._data: Any = self._model.createData()
        self._frames = [self._model.getFrameId(f"{link}_center") for link in foot_links_in_urdf(robot.config)]
        self._legs = [robot.velocity_indices[joints_of(leg)] for leg in range(LEG_COUNT)]
        self._configuration = pin.neutral(self._model)
        self._velocity = np.zeros(self._model.nv)
        self._acceleration = np.zeros(self._model.nv)

    def kinematics(self, joint_positions: Array, joint_velocities: Array) -> LegKinematics:
        """Return the feet for joint angles, (12,) in [rad], and velocities, (12,) in [rad/s]."""
        self._configuration[self._robot.position_indices] = joint_positions
        pin.computeJointJacobians(self._model, self._data, self._configuration)
        pin.updateFramePlacements(self._model, self._data)
        centers, jacobians = np.empty((LEG_COUNT, 3)), np.empty((LEG_COUNT, 6, 3))
        placements, axes = self._data.oMf, pin.LOCAL_WORLD_ALIGNED
        for leg, (frame, columns) in enumerate(zip(self._frames, self._legs, strict=True)):
            centers[leg] = placements[frame].translation
            jacobians[leg] = pin.getFrameJacobian(self._model, self._data, frame, axes)[:, columns]
        velocities = joint_velocities.reshape(LEG_COUNT, 3, 1)
        return LegKinematics(centers, jacobians[:, :3], (jacobians[:, 3:] @ velocities)[:, :, 0])

    def foot_forces(self, reading: SensorReading, legs: LegKinematics, joint_accelerations: Array) -> Array:
        """Return the ground's forces that explain the joint torques, in base axes, (4, 3) in [N].

        From M u_dot + h = S^T tau + sum_i J_i^T lambda_i the rows of leg i give

            lambda_i = J_i^-T ((M u_dot + h)_i - tau_i).

        The base accelerates as the inertial unit says; its angular acceleration is neglected.

        Args:
            reading: of the sensors.
            legs: kinematics at this reading.
            joint_accelerations: (12,) in [rad/s^2].
        """
        motion = self._inverse_dynamics(reading, joint_accelerations)
        unexplained = (motion - reading.joint_torques).reshape(LEG_COUNT, 3, 1)
        forces = np.linalg.solve(legs.jacobians.transpose(0, 2, 1), unexplained)
        return np.asarray(forces[:, :, 0], np.float64)

    def _inverse_dynamics(self, reading: SensorReading, joint_accelerations: Array) -> Array:
        """Return the joint torques that the motion takes without contact, (12,) in [N m].

        Base axes serve as inertial axes, in which the base moves with its own acceleration only: the specific force is
        what gravity and that acceleration amount to.
        """
        robot = self._robot
        self._configuration[robot.position_indices] = reading.joint_positions
        self._velocity[3:6] = reading.gyro
        self._velocity[robot.velocity_indices] = reading.joint_velocities
        self._acceleration[:3] = reading.accelerometer + self._model.gravity.linear
        self._acceleration[robot.velocity_indices] = joint_accelerations
        torques = pin.rnea(self._model, self._data, self._configuration, self._velocity, self._acceleration)
        motion: Array = torques[robot.velocity_indices] + robot.joint_damping * reading.joint_velocities
        return motion.reshape(JOINT_COUNT)
