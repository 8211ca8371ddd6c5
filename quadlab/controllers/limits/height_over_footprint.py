"""Height of the base over its footprint (Bellicoso 2016, Eq. 32-34)."""

from typing import Literal

from quadlab.configuration import register
from quadlab.controllers.limits.second_order import HeightRangeConfig, position_limit
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows
from quadlab.robots.kinematics import Kinematics


@register("task", "height_over_footprint")
class HeightOverFootprintLimit:
    """h_min <= z_B - h_z <= h_max with h_z the mean height of the standing feet."""

    class Config(HeightRangeConfig):
        """How high the base may be over the feet."""

        task: Literal["height_over_footprint"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return one row in accelerations; none if no foot stands."""
        feet = kinematics.foot_positions[reference.stance, 2]
        row = slice(2, 3) if len(feet) else slice(0, 0)
        return position_limit(
            kinematics.base_jacobian[row],
            kinematics.base_bias[row],
            kinematics.base_position[row] - feet.sum() / max(len(feet), 1),
            kinematics.base_linear_velocity[row],
            self.config.bounds(reference.standing_height),
            self.config.look_ahead_s,
        )
