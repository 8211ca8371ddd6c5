"""Height of the base that keeps the knees away from their singularity (Bellicoso 2016, Eq. 22-24)."""

from typing import Literal

import numpy as np

from quadlab.configuration import NonNegative, Positive, StrictModel, register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows, Variable, equation
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import JOINTS, Kinematics
from quadlab.robots.legs import LEG_COUNT, joints_of


def leg_manipulability(jacobian: Array) -> float:
    """Return m = sqrt(det(J J^T)), Eq. (22), of the (3, 3) Jacobian of a foot by the joints of its leg."""
    return abs(float(np.linalg.det(jacobian)))


def knee_gradient(jacobian: Array, axes: Array) -> float:
    """Return dm / dq_KFE = m Tr(dJ/dq_KFE J^+), Eq. (23).

    The axes of the joints do not turn with the knee, so dJ/dq_KFE has the columns a_j x J_KFE.

    Args:
        jacobian: of the foot by the joints HAA, HFE, KFE, (3, 3) in world axes.
        axes: of these joints, columns of (3, 3) in world axes.
    """
    derivative = np.cross(axes, jacobian[:, 2:3], axis=0)
    return leg_manipulability(jacobian) * float(np.trace(derivative @ np.linalg.pinv(jacobian)))


@register("task", "manipulability_height")
class ManipulabilityHeightTask:
    """z_ddot = k_0 sum_k s_k dm_k/dq_KFE - k_d z_dot, with s_k = +-1.

    Eq. (23) adds up the gradients by the knee angles as if every knee lifted the base when its angle grows; here each
    is taken in the direction s_k in which its knee lengthens the leg: the same for robots whose knees point that way,
    and right for the others. All legs count alike, w_k = 1.
    """

    class Config(StrictModel):
        """Pull and damping.

        Attributes:
            pull: k_0 in [1/s^2 per m^3 of manipulability and rad].
            damping_per_s: k_d in [1/s].
        """

        task: Literal["manipulability_height"]
        pull: Positive
        damping_per_s: NonNegative

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return one row in accelerations."""
        upward = 0.0
        for leg in range(LEG_COUNT):
            jacobian = kinematics.foot_jacobians[leg][:, JOINTS][:, joints_of(leg)]
            reach = kinematics.foot_positions[leg] - kinematics.hip_positions[leg]
            lengthens = np.sign(reach @ jacobian[:, 2])
            upward += lengthens * knee_gradient(jacobian, kinematics.leg_joint_axes[leg])
        target = self.config.pull * upward - self.config.damping_per_s * kinematics.base_linear_velocity[2:3]
        return equation(Variable.ACCELERATION, kinematics.base_jacobian[2:3], target - kinematics.base_bias[2:3])
