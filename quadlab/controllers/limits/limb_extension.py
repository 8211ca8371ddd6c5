"""Hips that stay within reach of their feet in height (Bellicoso 2016, Eq. 35): what adapts the body to the terrain."""

from typing import Literal

import numpy as np

from quadlab.configuration import register
from quadlab.controllers.limits.second_order import HeightRangeConfig, position_limit
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows
from quadlab.geometry.rotations import skew
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
        omega = kinematics.base_angular_velocity
        jacobians, biases = [], []
        for arm in kinematics.hip_positions - kinematics.base_position:
            jacobians.append((kinematics.base_jacobian[:3] - skew(arm) @ kinematics.base_jacobian[3:])[2])
            centripetal = np.cross(omega, np.cross(omega, arm))
            biases.append((kinematics.base_bias[:3] - skew(arm) @ kinematics.base_bias[3:] + centripetal)[2])
        jacobian = np.stack(jacobians)
        return position_limit(
            jacobian,
            np.array(biases),
            kinematics.hip_positions[:, 2] - kinematics.foot_positions[:, 2],
            jacobian @ kinematics.generalized_velocity,
            self.config.bounds(reference.standing_height),
            self.config.look_ahead_s,
        )
