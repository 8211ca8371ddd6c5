"""A plan laid on the ground: where its curves, footholds and support areas lie in the frame of a figure."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.polygons import convex_hull
from quadlab.geometry.rotations import Array, rotation_2d
from quadlab.planners.plan import MotionPlan
from quadlab.robots.legs import LEG_COUNT

PoseAt = Callable[[float], Array]
"""Pose x, y in [m] and yaw in [rad] of the plan frame at a plan time in [s], (3,)."""

_SAMPLE_PERIOD = 0.01  # [s]


@dataclass(frozen=True)
class SupportArea:
    """The hull of the feet that stand in one phase.

    Attributes:
        corners: counter-clockwise, (m, 2) in [m]; two for a line.
        contacts: which legs stand, (4,).
    """

    corners: Array
    contacts: BoolArray


@dataclass(frozen=True)
class PlacedPlan:
    """What a view from above shows of a plan; positions in [m] in the frame of the figure.

    Attributes:
        times_s: plan times of the curves, (n,) in [s].
        contacts: which legs stand at these times, (n, 4).
        com, cop: curves, (n, 2).
        footholds: of each leg, where it starts and where its swings end, (k, 2).
        supports: of the phases in order of time.
    """

    times_s: Array
    contacts: BoolArray
    com: Array
    cop: Array
    footholds: tuple[Array, ...]
    supports: tuple[SupportArea, ...]


def in_plan_frame(plan: MotionPlan) -> PlacedPlan:
    """Return the plan where it was made."""
    return place_plan(plan, lambda _: np.zeros(3), plan.duration_s)


def place_plan(plan: MotionPlan, pose_at: PoseAt, until_s: float) -> PlacedPlan:
    """Return the part of a plan up to the plan time ``until_s`` in [s], in the frame that ``pose_at`` leads to.

    A plan that follows the robot (Gehring 2017, III-A) has no single place: curves are placed at their own time,
    support areas in the middle of their phase and footholds in the middle of their stance.
    """
    times = np.append(np.arange(0.0, until_s, _SAMPLE_PERIOD), until_s)
    com = np.array([_placed(plan.com(time)[:2], pose_at(time)) for time in times])
    cop = np.array([_placed(plan.cop(time), pose_at(time)) for time in times])
    return PlacedPlan(
        times_s=times,
        contacts=np.array([plan.schedule.contacts_at(time) for time in times]),
        com=com,
        cop=cop,
        footholds=tuple(_footholds(plan, leg, pose_at, until_s) for leg in range(LEG_COUNT)),
        supports=tuple(_supports(plan, pose_at, until_s)),
    )


def stance_spans(plan: MotionPlan, leg: int, until_s: float) -> list[tuple[float, float]]:
    """Return begin and end in [s] of the stances of ``leg`` that begin before ``until_s``, one a foothold."""
    swings = plan.schedule.swings[leg]
    begins = [0.0, *(swing.end_s for swing in swings)]
    ends = [*(swing.start_s for swing in swings), plan.duration_s]
    return [(b, min(e, until_s)) for b, e in zip(begins, ends, strict=True) if b <= until_s]


def _footholds(plan: MotionPlan, leg: int, pose_at: PoseAt, until_s: float) -> Array:
    spans = stance_spans(plan, leg, until_s)
    places = zip(plan.footholds[leg][:, :2], spans, strict=False)
    return np.array([_placed(foothold, pose_at(0.5 * (begin + end))) for foothold, (begin, end) in places])


def _supports(plan: MotionPlan, pose_at: PoseAt, until_s: float) -> list[SupportArea]:
    found = []
    for begin, end in pairwise(plan.schedule.switch_times_s):
        middle = 0.5 * float(begin + min(end, until_s))
        contacts = plan.schedule.contacts_at(middle)
        if begin >= until_s or not contacts.any():
            continue
        standing = np.flatnonzero(contacts).tolist()
        feet = [plan.foothold_at(leg, middle)[:2] for leg in standing]
        found.append(SupportArea(convex_hull(np.array([_placed(foot, pose_at(middle)) for foot in feet])), contacts))
    return found


def _placed(point: Array, pose: Array) -> Array:
    moved: Array = pose[:2] + rotation_2d(float(pose[2])) @ point
    return moved
