"""The legs as the base sees them: where the feet are, how they move, what force they feel."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin

from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry
from quadlab.robots.config import foot_links_in_urdf
from quadlab.robots.legs import JOINT_COUNT, JOINTS_PER_LEG, LEG_COUNT
from quadlab.robots.model import RobotModel
from quadlab.robots.pinocchio_model import IndexArray
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
        frames = [self._model.getFrameId(f"{link}_center") for link in foot_links_in_urdf(robot.config)]
        self._feet = tuple(self._data.oMf[frame].translation for frame in frames)  # memory that Pinocchio writes to
        self._jacobian = self._data.J
        self._joints_of_legs = robot.velocity_indices.reshape(LEG_COUNT, JOINTS_PER_LEG)
        self._configuration = pin.neutral(self._model)
        self._velocity = np.zeros(self._model.nv)
        self._acceleration = np.zeros(self._model.nv)

    def kinematics(self, joint_positions: Array, joint_velocities: Array) -> LegKinematics:
        """Return the feet for joint angles, (12,) in [rad], and velocities, (12,) in [rad/s]."""
        self._configuration[self._robot.position_indices] = joint_positions
        pin.computeJointJacobians(self._model, self._data, self._configuration)
        pin.updateFramePlacements(self._model, self._data)
        return LegKinematics(*_leg_terms(self._jacobian, self._feet, self._joints_of_legs, joint_velocities))

    def foot_forces(self, reading: SensorReading, legs: LegKinematics, joint_accelerations: Array) -> Array:
        """Return the ground's forces that explain the joint torques, in base axes, (4, 3) in [N].

        From M u_dot + h = S^T tau + sum_i J_i^T lambda_i the rows of leg i give

            lambda_i = J_i^-T ((M u_dot + h)_i - tau_i).

        The base accelerates as the inertial unit says, biases included; its angular acceleration is neglected. The
        forces are taken to act at the centres of the foot spheres, which with 60 N sideways errs by about 5 N.

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


@compiled_entry
def _leg_terms(
    jacobian: Array, feet: tuple[Array, ...], joints: IndexArray, joint_velocities: Array
) -> tuple[Array, Array, Array]:
    """Return centres (4, 3), Jacobians (4, 3, 3) and spins (4, 3) of the feet, as in ``LegKinematics``.

    Args:
        jacobian: spatial velocity [v at the base origin, omega] by each entry of Pinocchio's velocity, (6, 18).
        feet: centres of the foot spheres, four of (3,).
        joints: columns of each leg in ``jacobian``, (4, 3).
        joint_velocities: (12,) in [rad/s].
    """
    legs, size = joints.shape
    centers, jacobians, spins = np.empty((legs, 3)), np.empty((legs, 3, size)), np.zeros((legs, 3))
    for leg in range(legs):
        x, y, z = feet[leg][0], feet[leg][1], feet[leg][2]
        centers[leg] = feet[leg]
        for joint in range(size):
            column = jacobian[:, joints[leg, joint]]
            vx, vy, vz, wx, wy, wz = column[0], column[1], column[2], column[3], column[4], column[5]
            jacobians[leg, 0, joint] = vx + wy * z - wz * y
            jacobians[leg, 1, joint] = vy + wz * x - wx * z
            jacobians[leg, 2, joint] = vz + wx * y - wy * x
            speed = joint_velocities[leg * size + joint]
            spins[leg, 0] += wx * speed
            spins[leg, 1] += wy * speed
            spins[leg, 2] += wz * speed
    return centers, jacobians, spins
