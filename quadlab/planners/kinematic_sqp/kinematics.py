"""Forward kinematics of base coordinates, Eq. (3): centre of mass and feet as functions of q, with Jacobians."""

from typing import Any

import numpy as np
import pinocchio as pin

from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.layout import POSE_SIZE
from quadlab.robots.legs import JOINTS_PER_LEG, LEG_COUNT
from quadlab.robots.model import RobotModel
from quadlab.robots.pinocchio_model import add_foot_frames

_BASE_SIZE = 6
_LEG_COLUMNS = tuple(
    [*range(_BASE_SIZE), *range(_BASE_SIZE + JOINTS_PER_LEG * leg, _BASE_SIZE + JOINTS_PER_LEG * (leg + 1))]
    for leg in range(LEG_COUNT)
)
LEG_POSE_COLUMNS = np.array(_LEG_COLUMNS)
"""The entries of q on which each foot depends: base and its three joints, (4, 9)."""


class SampleKinematics:
    """Centre of mass and contact points as functions of q = [base position, yaw, pitch, roll, 12 joints].

    The root joint is a translation with ZYX Euler angles, so that Pinocchio's Jacobians are derivatives by q. An
    instance owns a Pinocchio workspace, so it must not be shared between threads.

    Args:
        robot: the robot.
    """

    def __init__(self, robot: RobotModel) -> None:
        root = pin.JointModelComposite()
        root.addJoint(pin.JointModelTranslation())
        root.addJoint(pin.JointModelSphericalZYX())
        self._model: Any = pin.buildModelFromXML(robot.urdf_text, root)
        self._frames = add_foot_frames(robot.config, self._model)
        self._data: Any = self._model.createData()
        joints = [self._model.joints[self._model.getJointId(name)].idx_q for name in robot.joint_names]
        self._order = np.array([*range(_BASE_SIZE), *joints])
        self._leg_columns = [self._order[list(columns)] for columns in _LEG_COLUMNS]
        self._foot_radius = robot.foot_radius

    def positions(self, poses: Array) -> tuple[Array, Array]:
        """Return the CoM, (N, 3), and the contact points, (N, 4, 3), in [m], of configurations (N, 18)."""
        model, data = self._model, self._data
        com, feet = np.empty((len(poses), 3)), np.empty((len(poses), LEG_COUNT, 3))
        q = np.empty(POSE_SIZE)
        for sample, pose in enumerate(poses):
            q[self._order] = pose
            pin.framesForwardKinematics(model, data, q)
            com[sample] = pin.centerOfMass(model, data, False)
            for leg, frame in enumerate(self._frames):
                feet[sample, leg] = data.oMf[frame].translation
        feet[:, :, 2] -= self._foot_radius
        return com, feet

    def jacobians(self, poses: Array) -> tuple[Array, Array]:
        """Return d CoM / dq, (N, 3, 18), and d foot / d(base, its joints), (N, 4, 3, 9)."""
        model, data, axes = self._model, self._data, pin.LOCAL_WORLD_ALIGNED
        com = np.empty((len(poses), 3, POSE_SIZE))
        feet = np.empty((len(poses), LEG_COUNT, 3, _BASE_SIZE + JOINTS_PER_LEG))
        q = np.empty(POSE_SIZE)
        for sample, pose in enumerate(poses):
            q[self._order] = pose
            com[sample] = pin.jacobianCenterOfMass(model, data, q)[:, self._order]
            pin.updateFramePlacements(model, data)
            for leg, frame in enumerate(self._frames):
                feet[sample, leg] = pin.getFrameJacobian(model, data, frame, axes)[:3, self._leg_columns[leg]]
        return com, feet
