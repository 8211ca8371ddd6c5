"""Hips that stay within reach of their feet in height (Bellicoso 2016, Eq. 35): what adapts the body to the terrain."""

from typing import Literal

import numpy as np

from quadlab.configuration import register
from quadlab.controllers.limits.second_order import HeightRangeConfig, position_limit
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry
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
        jacobian, bias, heights, speeds = _hip_height_rows(
            kinematics.base_jacobian,
            kinematics.base_bias,
            kinematics.base_angular_velocity,
            kinematics.generalized_velocity,
            kinematics.base_position,
            (kinematics.hip_positions, kinematics.foot_positions),
        )
        return position_limit(
            jacobian,
            bias,
            heights,
            speeds,
            self.config.bounds(reference.standing_height),
            self.config.look_ahead_s,
        )


@compiled_entry
def _hip_height_rows(
    base_jacobian: Array, base_bias: Array, omega: Array, u: Array, base: Array, hips_and_feet: tuple[Array, Array]
) -> tuple[Array, Array, Array, Array]:
    """Return J (4, 18) and J_dot u (4,) of the heights of the hips, those over the feet (4,) and J u (4,).

    The z components of r_ddot_B + omega_dot x arm + omega x (omega x arm), with the arms from ``base`` to the hips.
    """
    hips, feet = hips_and_feet
    jacobian, bias = np.empty((len(hips), base_jacobian.shape[1])), np.empty(len(hips))
    heights, speeds = hips[:, 2] - feet[:, 2], np.zeros(len(hips))
    for leg in range(len(hips)):
        x, y, z = hips[leg, 0] - base[0], hips[leg, 1] - base[1], hips[leg, 2] - base[2]
        jacobian[leg] = base_jacobian[2] + y * base_jacobian[3] - x * base_jacobian[4]
        along = omega[0] * x + omega[1] * y + omega[2] * z
        centripetal = omega[2] * along - (omega[0] ** 2 + omega[1] ** 2 + omega[2] ** 2) * z
        bias[leg] = base_bias[2] + y * base_bias[3] - x * base_bias[4] + centripetal
        for column in range(len(u)):
            speeds[leg] += jacobian[leg, column] * u[column]
    return jacobian, bias, heights, speeds
