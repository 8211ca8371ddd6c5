"""Hips that stay within reach of their feet in height (Bellicoso 2016, Eq. 35): what adapts the body to the terrain."""

from typing import Literal

import numpy as np

from quadlab.configuration import register
from quadlab.controllers.hierarchy.jit import compiled_entry
from quadlab.controllers.limits.second_order import HeightRangeConfig, position_limit
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics


@register("task", "limb_extension")
class LimbExtensionLimit:
    """h_min <= z_hip - z_foot <= h_max for each leg; the foot's own motion is not part of the limit."""

    class Config(HeightRangeConfig):
        """How far a leg may reach: height of the hip over its foot."""

        task: Literal["limb_extension"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return one row in accelerations for each leg."""
        jacobian, bias = _hip_height_rows(
            kinematics.base_jacobian,
            kinematics.base_bias,
            kinematics.base_angular_velocity,
            kinematics.hip_positions - kinematics.base_position,
        )
        return position_limit(
            jacobian,
            bias,
            kinematics.hip_positions[:, 2] - kinematics.foot_positions[:, 2],
            jacobian @ kinematics.generalized_velocity,
            self.config.bounds(reference.standing_height),
            self.config.look_ahead_s,
        )


@compiled_entry
def _hip_height_rows(base_jacobian: Array, base_bias: Array, omega: Array, arms: Array) -> tuple[Array, Array]:
    """Return J (4, 18) and J_dot u (4,) of the heights of the hips at ``arms`` (4, 3) from the base origin.

    The z components of r_ddot_B + omega_dot x arm + omega x (omega x arm).
    """
    jacobian, bias = np.empty((len(arms), base_jacobian.shape[1])), np.empty(len(arms))
    for leg in range(len(arms)):
        x, y, z = arms[leg]
        jacobian[leg] = base_jacobian[2] + y * base_jacobian[3] - x * base_jacobian[4]
        along = omega[0] * x + omega[1] * y + omega[2] * z
        centripetal = omega[2] * along - (omega[0] ** 2 + omega[1] ** 2 + omega[2] ** 2) * z
        bias[leg] = base_bias[2] + y * base_bias[3] - x * base_bias[4] + centripetal
    return jacobian, bias
