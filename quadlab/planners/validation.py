"""What makes a planning problem well formed, and a bound on how far a schedule can carry a robot."""

import numpy as np

from quadlab.errors import PlanningProblemError
from quadlab.gaits.schedule import BoolArray, ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.planners.problem import PlanningModel, PlanningProblem, PlanStart, Waypoints
from quadlab.robots.legs import foot_names

_POSE_TOLERANCE = 1e-6  # [m], [rad]
_TIME_TOLERANCE = 1e-6  # [s]


def validate_problem(problem: PlanningProblem) -> None:
    """Check shapes, finiteness, timing and contacts of ``problem``.

    Raises:
        PlanningProblemError: with the first thing that is wrong.
    """
    feet = len(problem.model.nominal_feet)
    _validate_model(problem.model)
    _validate_start(problem.start, feet)
    _validate_schedule(problem.schedule, feet)
    _validate_waypoints(problem.waypoints, problem.schedule.duration_s)
    start = np.append(problem.start.com_position, problem.start.yaw)
    if np.abs(problem.waypoints.poses[0] - start).max() > _POSE_TOLERANCE:
        raise PlanningProblemError(f"waypoints: the first pose is {problem.waypoints.poses[0]}, the start is {start}")


def farthest_travel(schedule: ContactSchedule, model: PlanningModel, turn_rad: float) -> float:
    """Return a distance in [m] that no CoM can exceed with this schedule and range of motion.

    While one foot stands the CoM stays within twice the half diagonal of its box, plus what turning adds. The
    bound follows a chain of stances that covers the schedule, always changing to the stance that lasts longest.

    Args:
        schedule: contact flags.
        model: robot as the planner sees it.
        turn_rad: change of heading over the whole motion in [rad].
    """
    stances = 0
    phase, phases = 0, len(schedule.contacts)
    while phase < phases:
        lengths = [_stance_length(schedule.contacts[phase:, leg]) for leg in range(schedule.contacts.shape[1])]
        phase += max(lengths)
        stances += 1
    arm = float(np.linalg.norm(model.nominal_feet, axis=1).max())
    return stances * 2.0 * float(np.linalg.norm(model.reach)) + arm * abs(turn_rad)


def _stance_length(contacts: BoolArray) -> int:
    """Return how many phases, counted from the first, a leg stays on the ground."""
    lifts = np.flatnonzero(~contacts)
    return int(lifts[0]) if len(lifts) else len(contacts)


def _finite(name: str, array: Array, shape: tuple[int, ...]) -> None:
    if np.shape(array) != shape:
        raise PlanningProblemError(f"{name}: has shape {np.shape(array)}, expected {shape}")
    if not np.isfinite(array).all():
        raise PlanningProblemError(f"{name}: holds NaN or infinity")


def _validate_model(model: PlanningModel) -> None:
    if not len(model.nominal_feet) or not len(model.foot_vertices):
        raise PlanningProblemError("model: nominal_feet or foot_vertices is empty, expected one foot and one vertex")
    _finite("model.nominal_feet", model.nominal_feet, (len(model.nominal_feet), 2))
    _finite("model.foot_vertices", model.foot_vertices, (len(model.foot_vertices), 2))
    _finite("model.reach", model.reach, (2,))
    for name, value in (("com_height", model.com_height), ("gravity", model.gravity)):
        if not 0.0 < value < np.inf:
            raise PlanningProblemError(f"model.{name}: {value:g} is not positive and finite")
    if not (model.reach > 0.0).all():
        raise PlanningProblemError(f"model.reach: {model.reach} is not positive")


def _validate_start(start: PlanStart, feet: int) -> None:
    _finite("start.com_position", start.com_position, (2,))
    _finite("start.com_velocity", start.com_velocity, (2,))
    _finite("start.yaw", np.asarray(start.yaw), ())
    _finite("start.feet", start.feet, (feet, 3))


def _validate_schedule(schedule: ContactSchedule, feet: int) -> None:
    phases = len(schedule.durations_s)
    if phases == 0:
        raise PlanningProblemError("schedule: has no phase")
    _finite("schedule.durations_s", schedule.durations_s, (phases,))
    if np.shape(schedule.contacts) != (phases, feet):
        raise PlanningProblemError(
            f"schedule.contacts: has shape {np.shape(schedule.contacts)}, expected {(phases, feet)} "
            f"(one row a phase, columns {', '.join(foot_names(feet))})"
        )
    for phase, duration in enumerate(schedule.durations_s):
        if duration <= 0.0:
            raise PlanningProblemError(f"schedule: phase {phase} lasts {duration:g} s, expected more than 0 s")
        if not schedule.contacts[phase].any():
            raise PlanningProblemError(f"schedule: no leg is in contact in phase {phase}, expected one or more")


def _validate_waypoints(waypoints: Waypoints, duration_s: float) -> None:
    count = len(waypoints.times_s)
    if count < 2:
        raise PlanningProblemError(f"waypoints: {count} given, expected a start and a goal")
    _finite("waypoints.times_s", waypoints.times_s, (count,))
    _finite("waypoints.poses", waypoints.poses, (count, 3))
    _finite("waypoints.yaw_rate", np.asarray(waypoints.yaw_rate), ())
    if not (np.diff(waypoints.times_s) > 0.0).all():
        raise PlanningProblemError("waypoints.times_s: not increasing")
    first, last = float(waypoints.times_s[0]), float(waypoints.times_s[-1])
    if abs(first) > _TIME_TOLERANCE or last > duration_s + _TIME_TOLERANCE:
        raise PlanningProblemError(
            f"waypoints.times_s: from {first:g} to {last:g} s, expected from 0 to at most {duration_s:g} s"
        )
