"""References of the legs in the air: swinging to an adapted foothold or searching the ground."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypeAlias

import numpy as np

from quadlab.controllers.telemetry import LegMode
from quadlab.controllers.tracking.alignment import PlanarPose, Point
from quadlab.controllers.tracking.config import SwingConfig
from quadlab.controllers.tracking.contact_machine import LegContact
from quadlab.controllers.tracking.foothold import balance_correction, within_reach
from quadlab.controllers.tracking.swing import search_motion, swing_motion
from quadlab.estimation.terrain_plane import TerrainPlane
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry, source_fingerprint
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import LEG_COUNT

_IDLE = np.full((3, LEG_COUNT, 3), np.nan)
_STANCE, _SEARCH = int(LegMode.STANCE), int(LegMode.SEARCH)
_NO_FLIGHT = (_STANCE, *(0.0,) * 8)

Lengths: TypeAlias = tuple[float, float, float, float]
"""Apex, depth below the ground, reach forward and sideways in [m]."""
Feedback: TypeAlias = tuple[float, float]
"""Gain and speed limit in [m/s] of the foothold correction."""


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

    @cached_property
    def _lengths(self) -> Lengths:
        shares = (self.config.apex, self.config.depth, self.config.reach_forward, self.config.reach_sideways)
        apex, depth, forward, sideways = (share * self.base_height for share in shares)
        return apex, depth, forward, sideways

    @property
    def _feedback(self) -> Feedback:
        return self.config.feedback, self.config.feedback_speed_limit_mps

    def motions(
        self,
        legs: list[LegContact],
        plan_time_s: float,
        clock: tuple[float, float],
        alignment: PlanarPose,
        com_velocity_reference: Array,
        kinematics: Kinematics,
        terrain: TerrainPlane,
    ) -> Array:
        """Return desired position, velocity and acceleration of each foot, (3, 4, 3); NaN for standing legs.

        Args:
            legs: contact states.
            plan_time_s: time in the plan in [s].
            clock: seconds of the plan in a second, and the change of this rate in [1/s].
            alignment: of the footholds.
            com_velocity_reference: desired velocity in the world, (2,) in [m/s].
            kinematics: measured.
            terrain: plane under the robot.
        """
        if all(leg.mode is LegMode.STANCE for leg in legs):
            return _IDLE
        return _motions(
            np.array([self._flight(number, leg, plan_time_s) for number, leg in enumerate(legs)]),
            clock,
            tuple(alignment),
            (kinematics.com_position, kinematics.com_velocity, com_velocity_reference),
            kinematics.base_rotation,
            tuple(terrain),
            self.nominal_feet,
            self._lengths,
            self._feedback,
            self.search_speed,
        )

    def _flight(self, number: int, leg: LegContact, plan_time_s: float) -> tuple[float, ...]:
        """Return what the motion of a leg depends on: a row of ``flights`` in ``_compile_motions``."""
        if leg.mode is LegMode.STANCE:
            return _NO_FLIGHT
        points = self.footholds[number]
        x, y, _ = points[min(leg.foothold + 1, len(points) - 1)].tolist()
        phase = min(1.0, leg.swing_phase(plan_time_s))
        return (leg.mode, phase, leg.swing_duration_s, leg.search_depth, *leg.lift_off_point.tolist(), x, y)


def _compile_motions(fingerprint: int) -> Callable[..., Array]:
    @compiled_entry
    def motions(
        flights: Array,
        clock: tuple[float, float],
        alignment: tuple[Point, Point, float],
        com: tuple[Array, Array, Array],
        rotation: Array,
        terrain: tuple[Point, float, Point],
        nominal_feet: Array,
        lengths: Lengths,
        feedback: Feedback,
        search_speed: float,
    ) -> Array:
        """Return the motions of ``FootPlanner.motions``.

        Args:
            flights: per leg mode, phase, duration in [s], search depth in [m], lift-off point (3) in [m] and planned
                foothold (2) in [m] in the plan frame, (4, 9).
            clock: seconds of the plan in a second, and the change of this rate in [1/s].
            alignment: point in the plan and in the world in [m], and yaw.
            com: position (3,), velocity (3,) and desired horizontal velocity (2,).
            rotation: base to world, (3, 3).
            terrain: origin, height and slope of the plane.
            nominal_feet: relative to the CoM in the heading frame, (4, 2) in [m].
            lengths, feedback, search_speed: of the planner.
        """
        _ = fingerprint  # a closure variable, so that the cached machine code follows a change of any file here
        rate, rate_change = clock
        in_plan, in_world, yaw = alignment
        position, velocity, desired_velocity = com
        origin, height, slope = terrain
        apex, depth, forward, sideways = lengths
        cosine, sine, heading = math.cos(yaw), math.sin(yaw), math.atan2(rotation[1, 0], rotation[0, 0])
        error = velocity[:2] - desired_velocity
        ground = height + slope[0] * (position[0] - origin[0]) + slope[1] * (position[1] - origin[1])
        result, foothold = np.full((3, len(flights), 3), np.nan), np.empty(3)
        for leg in range(len(flights)):
            mode, phase, duration_s, search_depth = flights[leg, :4]
            if mode == _STANCE:
                continue
            if mode == _SEARCH:
                result[:, leg] = search_motion(flights[leg, 4:7], search_depth, search_speed)
                continue
            x, y = flights[leg, 7] - in_plan[0], flights[leg, 8] - in_plan[1]
            correction = balance_correction(feedback[0], feedback[1], error, position[2] - ground, phase)
            correction[0] += in_world[0] + cosine * x - sine * y
            correction[1] += in_world[1] + sine * x + cosine * y
            foothold[:2] = within_reach(correction, position[:2], heading, nominal_feet[leg], (forward, sideways))
            rise = slope[0] * (foothold[0] - origin[0]) + slope[1] * (foothold[1] - origin[1])
            foothold[2] = height + rise - depth  # a little below the ground
            motion = swing_motion(flights[leg, 4:7], foothold, apex, phase, duration_s)
            motion[2] = rate**2 * motion[2] + rate_change * motion[1]
            motion[1] *= rate
            result[:, leg] = motion
        return result

    return motions


_motions = _compile_motions(source_fingerprint(Path(__file__).parent))
