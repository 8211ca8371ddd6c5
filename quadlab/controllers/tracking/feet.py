"""References of the legs in the air: swinging to an adapted foothold or searching the ground."""

from dataclasses import dataclass

import numpy as np

from quadlab.controllers.telemetry import LegMode
from quadlab.controllers.tracking.alignment import PlanarPose
from quadlab.controllers.tracking.config import SwingConfig
from quadlab.controllers.tracking.contact_machine import LegContact
from quadlab.controllers.tracking.foothold import balance_correction, within_reach
from quadlab.controllers.tracking.swing import FootMotion, search_motion, swing_motion
from quadlab.estimation.terrain_plane import TerrainPlane
from quadlab.geometry.rotations import Array, yaw_of
from quadlab.robots.kinematics import Kinematics

_IDLE = FootMotion(np.full(3, np.nan), np.full(3, np.nan), np.full(3, np.nan))


@dataclass(frozen=True)
class FootPlanner:
    """Gives the motion of every foot.

    Attributes:
        config: shape of the swing and foothold correction.
        base_height: standing height of the base, the unit of the lengths in ``config``, in [m].
        search_speed: downward speed of a searching foot in [m/s].
        nominal_feet: foot positions relative to the CoM in the heading frame, (4, 2) in [m].
        footholds: of the plan, per leg (swings + 1, 3) in [m].
    """

    config: SwingConfig
    base_height: float
    search_speed: float
    nominal_feet: Array
    footholds: tuple[Array, ...]

    def motions(
        self,
        legs: list[LegContact],
        plan_time_s: float,
        plan_rate: float,
        alignment: PlanarPose,
        com_velocity_reference: Array,
        kinematics: Kinematics,
        terrain: TerrainPlane,
    ) -> list[FootMotion]:
        """Return the desired motion of each foot; NaN for standing legs.

        Args:
            legs: contact states.
            plan_time_s: time in the plan in [s].
            plan_rate: seconds of the plan in a second.
            alignment: of the footholds.
            com_velocity_reference: desired velocity in the world, (2,) in [m/s].
            kinematics: measured.
            terrain: plane under the robot.
        """
        velocity_error = kinematics.com_velocity[:2] - com_velocity_reference
        motions = []
        for number, leg in enumerate(legs):
            if leg.mode is LegMode.STANCE:
                motions.append(_IDLE)
            elif leg.mode is LegMode.SEARCH:
                motions.append(search_motion(leg.lift_off_point, leg.search_depth, self.search_speed))
            else:
                phase = min(1.0, leg.swing_phase(plan_time_s))
                planned = alignment.position(self._next_foothold(number, leg))
                foothold = self._adapt(number, planned, velocity_error, phase, kinematics, terrain)
                apex = self.config.apex * self.base_height
                planned_motion = swing_motion(leg.lift_off_point, foothold, apex, phase, leg.swing_duration_s)
                motions.append(planned_motion.at_rate(plan_rate))
        return motions

    def _next_foothold(self, number: int, leg: LegContact) -> Array:
        points = self.footholds[number]
        return points[min(leg.foothold + 1, len(points) - 1), :2]

    def _adapt(
        self,
        number: int,
        planned: Array,
        velocity_error: Array,
        phase: float,
        kinematics: Kinematics,
        terrain: TerrainPlane,
    ) -> Array:
        """Correct a foothold for balance and reach and put it a little below the ground, (3,) in [m]."""
        com = kinematics.com_position[:2]
        com_height = float(kinematics.com_position[2]) - terrain.height_at(com)
        corrected = planned + balance_correction(self.config, velocity_error, com_height, phase)
        reach = (self.base_height * self.config.reach_forward, self.base_height * self.config.reach_sideways)
        heading = yaw_of(kinematics.base_rotation)
        foothold = within_reach(corrected, com, heading, self.nominal_feet[number], reach)
        return np.array([*foothold, terrain.height_at(foothold) - self.config.depth * self.base_height])
