"""How far a plan has been followed and where that leaves the feet: what the next plan begins from."""

from dataclasses import dataclass

import numpy as np

from quadlab.controllers.telemetry import LegMode
from quadlab.controllers.tracking.contact_machine import ContactMachine
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array


@dataclass(frozen=True)
class PlanProgress:
    """Where a controller is in its plan.

    Attributes:
        plan_time_s: time in the schedule of the first plan in [s].
        plan_pose_in_world: x, y in [m] and yaw in [rad] of the frame of the first plan as it lies now, (3,).
        feet: contact points of legs that stand or search, where legs in the air left the ground, (4, 3) in [m].
        standing: legs that stand, or will as soon as they find the ground, until their next swing, (4,); False for a
            leg in the air, and for one whose lift-off is due but has to wait.
        regular: whether every leg in the air is so by plan; if not, a new plan has to wait.
    """

    plan_time_s: float
    plan_pose_in_world: Array
    feet: Array
    standing: BoolArray
    regular: bool


def feet_in_progress(machine: ContactMachine, plan_time_s: float, feet: Array) -> tuple[Array, BoolArray, bool]:
    """Return ``feet``, ``standing`` and ``regular`` of ``PlanProgress``.

    Args:
        machine: contact states.
        plan_time_s: time in the schedule of ``machine`` in [s].
        feet: contact points now, (4, 3) in [m].
    """
    points, standing, regular = [], [], True
    for number, leg in enumerate(machine.legs):
        completed, swing = machine.schedule.swing_at(number, plan_time_s)
        points.append(leg.stance_point if leg.mode is LegMode.SWING else feet[number])
        swing_over = swing is None or leg.foothold > completed  # touched down early, or skipped
        standing.append(leg.mode is LegMode.SEARCH or (leg.mode is LegMode.STANCE and swing_over))
        regular &= leg.mode is not LegMode.SWING or not swing_over
    return np.stack(points), np.array(standing), regular
