"""A tracker and a robot that does not move, for tests of the references."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from controller_cases import gait_schedule, tracking_config

from quadlab.controllers.tracking.tracker import MotionTracker, TrackedTick
from quadlab.planners.plan import MotionPlan
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState

PERIOD = 0.0025  # [s]
SWING = 0.675  # [s] a time in the first swing of the shipped trot, in which LF and RH are in the air
TROT = gait_schedule("trot", 2.9)


def tracker_for(robot: RobotModel, plan: MotionPlan, start: RobotState, **changes: Any) -> MotionTracker:
    return MotionTracker(tracking_config(**changes), robot, PERIOD, plan, robot.kinematics(start))


def track(
    tracker: MotionTracker,
    state: RobotState,
    start_s: float,
    end_s: float,
    loaded: Sequence[int] | None = None,
) -> TrackedTick:
    """Last of the ticks over [start_s, end_s] with a robot that does not move, loaded as planned unless said."""
    kinematics, weight = tracker.robot.kinematics(state), tracker.robot.mass * 9.81
    for step in range(round((end_s - start_s) / PERIOD) + 1):
        time = start_s + step * PERIOD
        flags = tracker.plan.schedule.contacts_at(time)
        loads = [flags[leg] if loaded is None else leg in loaded for leg in range(4)]
        tick = tracker.update(time, kinematics, 0.25 * weight * np.array(loads))
    return tick
