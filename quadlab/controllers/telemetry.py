"""What a controller says about one tick, for log, plots and statistics."""

import math
from enum import IntEnum
from typing import NamedTuple

from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array


class LegMode(IntEnum):
    """What a leg is doing."""

    STANCE = 0
    SWING = 1
    SEARCH = 2
    """Past its planned touch-down, or its contact was lost: it reaches down until it touches."""


class ControlTelemetry(NamedTuple):
    """One tick of a controller; positions in world components and in [m] unless said.

    Attributes:
        plan_time_s: time at which the plan was looked up in [s]; it goes on if the plan is replaced.
        plan_pose_in_world: x, y in [m] and yaw in [rad] of the plan frame as the torso is aligned with it, (3,); if
            the plan was replaced, of the first one.
        com_position, com_velocity: measured, (3,) in [m], [m/s].
        com_position_reference, com_velocity_reference: (3,); z is the height that follows from the base height.
        base_height_reference: in [m].
        base_rpy_reference: roll, pitch, yaw in [rad], (3,).
        cop_reference: planned centre of pressure, (2,).
        terrain_plane: a, b, c of z = a + b (x - x_com) + c (y - y_com), (3,).
        foot_positions, foot_position_references: contact points, (4, 3); a stance foot's reference is NaN.
        foot_contact_velocities: of the material points of the feet at ``foot_positions``, (4, 3) in [m/s].
        leg_modes: ``LegMode`` of each leg, (4,).
        planned_contacts: flags of the plan, (4,).
        contact_forces_desired: (4, 3) in [N]; zero for legs in the air.
        torques_desired: before clipping to the limits, (12,) in [N m].
        level_residuals: norm of the unmet part of each level of the controller, by name.
        solver_iterations: of the tick.
        fallbacks: ticks so far in which the solver's answer was not used.
        model_us, reference_us, solve_us: computing time of the tick's parts in [us].
        certificate: how far from optimal the solver's answer is, largest over the levels; NaN if it was not asked for.
        events: what happened in this tick, one line each, e.g. "LF early touch-down at 0.82 of swing".
    """

    plan_time_s: float
    plan_pose_in_world: Array
    com_position: Array
    com_velocity: Array
    com_position_reference: Array
    com_velocity_reference: Array
    base_height_reference: float
    base_rpy_reference: Array
    cop_reference: Array
    terrain_plane: Array
    foot_positions: Array
    foot_position_references: Array
    foot_contact_velocities: Array
    leg_modes: tuple[LegMode, ...]
    planned_contacts: BoolArray
    contact_forces_desired: Array
    torques_desired: Array
    level_residuals: dict[str, float]
    solver_iterations: int
    fallbacks: int
    model_us: float
    reference_us: float
    solve_us: float
    certificate: float = math.nan
    events: tuple[str, ...] = ()

    @property
    def tick_us(self) -> float:
        """Computing time of the whole tick in [us]."""
        return self.model_us + self.reference_us + self.solve_us
