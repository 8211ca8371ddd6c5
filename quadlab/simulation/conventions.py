"""The one border where states cross between quadlab and MuJoCo; joints are matched by name.

MuJoCo: qpos = [base position, quaternion wxyz, joints], qvel = [base velocity in world, angular velocity in base,
joints], joints in the order of the model. Quadlab: see ``RobotState``. Pinocchio's velocity is in base axes, so
v_MuJoCo = G v_u with G = blkdiag(R, I, permutation).
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadlab.geometry.rotations import Array, quat_to_matrix
from quadlab.robots.kinematics import BASE_ANGULAR, BASE_LINEAR, JOINTS, VELOCITY_SIZE
from quadlab.robots.legs import LEG_COUNT
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState

_CONTACT_FORCE_OFFSET = 1
"""The contact sensor reports the number of contacts first, then the force."""


@dataclass(frozen=True)
class PhysicsArrays:
    """The arrays of an ``MjData`` that every step needs, by their names in MuJoCo.

    They are views of the physics' own memory; asking MuJoCo for them anew takes longer than reading them.

    Attributes:
        qpos, qvel: positions and velocities in MuJoCo's conventions.
        ctrl: torques of the motors in [N m].
        sensordata: of all sensors.
    """

    qpos: Array
    qvel: Array
    ctrl: Array
    sensordata: Array

    @classmethod
    def of(cls, data: Any) -> "PhysicsArrays":
        """Return views of ``data``, which must live as long as they do."""
        return cls(data.qpos, data.qvel, data.ctrl, data.sensordata)


@dataclass(frozen=True)
class MujocoMap:
    """Where a robot's parts are in the arrays of a compiled model.

    Attributes:
        qpos: indices of the joint angles, (12,).
        qvel: indices of the joint velocities, (12,).
        ctrl: indices of the torque motors, (12,).
        foot_forces: indices of the foot force components in the sensor data, (4, 3).
    """

    qpos: NDArray[np.intp]
    qvel: NDArray[np.intp]
    ctrl: NDArray[np.intp]
    foot_forces: NDArray[np.intp]

    @classmethod
    def of(cls, model: Any, robot: RobotModel) -> "MujocoMap":
        """Look up the parts of ``robot`` in the compiled ``model`` by name."""
        first = np.array([model.sensor(foot_force_sensor(leg)).adr[0] for leg in range(LEG_COUNT)])
        return cls(
            qpos=np.array([model.joint(name).qposadr[0] for name in robot.joint_names]),
            qvel=np.array([model.joint(name).dofadr[0] for name in robot.joint_names]),
            ctrl=np.array([model.actuator(name).id for name in robot.joint_names]),
            foot_forces=first[:, None] + _CONTACT_FORCE_OFFSET + np.arange(3),
        )

    def write_state(self, data: PhysicsArrays, state: RobotState) -> None:
        """Set positions and velocities of ``data`` to those of ``state``."""
        data.qpos[:3] = state.position_base_in_world
        data.qpos[3:7] = state.quat_wxyz
        data.qpos[self.qpos] = state.joint_positions
        data.qvel[:3] = state.linear_velocity_base_in_world
        data.qvel[3:6] = state.angular_velocity_base_in_base
        data.qvel[self.qvel] = state.joint_velocities

    def read_state(self, data: PhysicsArrays, time_s: float) -> RobotState:
        """Return the state in ``data``; the contact sensor gives the foot's force on the ground, hence the sign."""
        quat = data.qpos[3:7]
        return RobotState(
            time_s=time_s,
            position_base_in_world=data.qpos[:3].copy(),
            quat_wxyz=quat / math.hypot(*quat.tolist()),
            joint_positions=data.qpos[self.qpos],
            linear_velocity_base_in_world=data.qvel[:3].copy(),
            angular_velocity_base_in_base=data.qvel[3:6].copy(),
            joint_velocities=data.qvel[self.qvel],
            foot_forces_in_world=-data.sensordata[self.foot_forces],
        )

    def joints(self, data: PhysicsArrays) -> tuple[Array, Array]:
        """Return joint angles and velocities, (12,) each in [rad], [rad/s]."""
        return data.qpos[self.qpos], data.qvel[self.qvel]

    def velocity_transform(self, quat_wxyz: Array) -> Array:
        """Return G, (18, 18), with qvel = G u for the generalised velocity u of ``Kinematics``."""
        transform = np.zeros((VELOCITY_SIZE, VELOCITY_SIZE))
        transform[:3, BASE_LINEAR] = quat_to_matrix(quat_wxyz)
        transform[3:6, BASE_ANGULAR] = np.eye(3)
        transform[self.qvel, np.arange(JOINTS.start, JOINTS.stop)] = 1.0
        return transform


GYROSCOPE, ACCELEROMETER = "gyroscope", "accelerometer"
"""Names of the inertial sensors, at the base origin in base axes."""


def foot_force_sensor(leg: int) -> str:
    """Return the name of the contact sensor of foot number ``leg``."""
    return f"foot_force_{leg}"


def foot_geom(leg: int) -> str:
    """Return the name of the sphere of foot number ``leg``."""
    return f"foot_{leg}"
