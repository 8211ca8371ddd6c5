"""Planning again while the trial runs: from the measured state, for what is left of the schedule."""

from dataclasses import dataclass, field

import numpy as np

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.controllers.controller import Controller
from quadlab.controllers.tracking.handover import PlanProgress
from quadlab.gaits.schedule import BoolArray, ContactSchedule
from quadlab.geometry.rotations import Array, rotation_2d, yaw_of
from quadlab.planners.planner import Planner, solved
from quadlab.planners.problem import PlanningProblem, PlanStart, Waypoints
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState

_TIME_TOLERANCE = 1e-6  # [s]


class ReplanningConfig(StrictModel):
    """When a motion is planned again.

    Attributes:
        period_s: time between two plans in [s]; None plans once, before the motion.
        shortest_phase_s: planning waits while the next switch of contacts is nearer than this, in [s]: so late a new
            foothold would only tear at the foot. Waypoints that are nearer are left out, except the goal.
        all_feet_down: planning waits for all legs to stand, as planners that move joints need it.
    """

    period_s: Positive | None
    shortest_phase_s: NonNegative
    all_feet_down: bool


@dataclass
class Replanner:
    """Replaces the plan of a controller every period; a failure leaves the old plan and is counted.

    Simulated time stands still while a plan is made. The last plan is made before the last swing ends.

    Attributes:
        config: when.
        robot: that moves.
        planner: asked each time.
        problem: of the first plan; its schedule and waypoints hold for the whole motion.
        attempts, failures: how often a plan was asked for, and not found.
        plan_times_ms: wall time of building and solving of each plan found in [ms].
    """

    config: ReplanningConfig
    robot: RobotModel
    planner: Planner
    problem: PlanningProblem
    attempts: int = 0
    failures: int = 0
    plan_times_ms: list[float] = field(default_factory=list)
    _next_s: float | None = None

    def update(self, controller: Controller, state: RobotState) -> str | None:
        """Replace the plan of ``controller`` if it is time; return in one line what happened, None if nothing did.

        Args:
            controller: that has followed the plan up to now.
            state: as measured at the tick that begins.
        """
        if not self._is_due(state.time_s):
            return None
        progress = controller.progress(state)
        waits = not progress.regular or (self.config.all_feet_down and not progress.standing.all())
        if waits or not self._is_worth_it(progress.plan_time_s):
            return None
        self._next_s = state.time_s + (self.config.period_s or 0.0)
        self.attempts += 1
        rest = remaining_problem(self.problem, progress, self.robot, state, self.config.shortest_phase_s)
        outcome = solved(self.planner, rest)
        if outcome.plan is None:
            self.failures += 1
            return f"replanning failed, the old plan holds: {outcome.status}: {outcome.reason}"
        controller.replace_plan(outcome.plan, state)
        self.plan_times_ms.append(outcome.plan.report.build_ms + outcome.plan.report.solve_ms)
        return "new plan"

    def summary(self) -> dict[str, float | int | None]:
        """Return the numbers by their names in ``TrialResult``; empty if planning was to happen once."""
        if self.config.period_s is None:
            return {}
        median = float(np.median(self.plan_times_ms)) if self.plan_times_ms else None
        return {"replannings": self.attempts, "replanning_failures": self.failures, "replanning_median_ms": median}

    def _is_due(self, time_s: float) -> bool:
        if self.config.period_s is None:
            return False
        if self._next_s is None:
            self._next_s = time_s + self.config.period_s
        return time_s >= self._next_s - _TIME_TOLERANCE

    def _is_worth_it(self, plan_time_s: float) -> bool:
        """Whether a swing is to end yet, and no switch of contacts is near."""
        switches = self.problem.schedule.switch_times_s
        following = switches[switches > plan_time_s + _TIME_TOLERANCE]
        last_touch_down = max((swings[-1].end_s for swings in self.problem.schedule.swings if swings), default=0.0)
        shortest_s = self.config.shortest_phase_s - _TIME_TOLERANCE
        far_enough = len(following) > 0 and following[0] - plan_time_s >= shortest_s
        return bool(far_enough) and plan_time_s < last_touch_down


def remaining_problem(
    problem: PlanningProblem, progress: PlanProgress, robot: RobotModel, state: RobotState, shortest_phase_s: float
) -> PlanningProblem:
    """Return what is left of ``problem``, seen from where the robot is.

    The plan frame is the world as the robot knows it, lowered to the ground. Waypoints lie where the alignment of the
    old plan has carried them: a robot that was pushed aside goes on beside its old path (Gehring 2017, III-A).

    Args:
        problem: of the first plan.
        progress: of the controller.
        robot: that moves.
        state: as measured.
        shortest_phase_s: a waypoint that is nearer than this is left out unless it is the goal, in [s].
    """
    kinematics = robot.kinematics(state)
    waypoints = _displaced(problem.waypoints, progress.plan_pose_in_world)
    planned_yaw = float(np.interp(progress.plan_time_s, waypoints.times_s, waypoints.poses[:, 2]))
    yaw = planned_yaw + float(np.angle(np.exp(1j * (yaw_of(kinematics.base_rotation) - planned_yaw))))
    feet = progress.feet.copy()
    feet[:, 2] = 0.0
    start = PlanStart(kinematics.com_position[:2], kinematics.com_velocity[:2], yaw, feet, state)
    pose, yaw_rate = np.array([*start.com_position, yaw]), float(kinematics.base_angular_velocity[2])
    return PlanningProblem(
        start=start,
        waypoints=_remaining_waypoints(waypoints, progress.plan_time_s, pose, yaw_rate, shortest_phase_s),
        schedule=standing_on(problem.schedule.after(progress.plan_time_s), progress.standing),
        model=problem.model,
        robot=problem.robot,
    )


def standing_on(schedule: ContactSchedule, standing: BoolArray) -> ContactSchedule:
    """Return ``schedule`` without the rest of the swings, under way at its start, of legs that are ``standing``, (4,).

    Such a leg has touched down before its time, or skipped its swing.
    """
    contacts = schedule.contacts.copy()
    for leg in np.flatnonzero(standing):
        swings = schedule.swings[leg]
        if swings and swings[0].start_s == 0.0:
            contacts[schedule.switch_times_s[:-1] < swings[0].end_s - _TIME_TOLERANCE, leg] = True
    return ContactSchedule(schedule.durations_s, contacts)


def _displaced(waypoints: Waypoints, pose: Array) -> Waypoints:
    """Return the waypoints with the frame that they are given in at ``pose``, x, y, yaw, (3,)."""
    positions = pose[:2] + waypoints.poses[:, :2] @ rotation_2d(float(pose[2])).T
    return Waypoints(waypoints.times_s, np.column_stack([positions, waypoints.poses[:, 2] + pose[2]]))


def _remaining_waypoints(
    waypoints: Waypoints, time_s: float, pose: Array, yaw_rate: float, shortest_s: float
) -> Waypoints:
    """Return ``pose``, (3,), now and the waypoints after ``time_s`` in [s]; ``yaw_rate`` now in [rad/s].

    Waypoints on the way that are nearer than ``shortest_s`` in [s] are left out: a robot beside its path would have to
    jump to them. The goal stays however near it is.
    """
    nearest_s = np.full(len(waypoints.times_s), max(shortest_s - _TIME_TOLERANCE, _TIME_TOLERANCE))
    nearest_s[-1] = _TIME_TOLERANCE
    later = waypoints.times_s - time_s > nearest_s
    times = np.append(0.0, waypoints.times_s[later] - time_s)
    return Waypoints(times, np.concatenate([pose[None], waypoints.poses[later]]), yaw_rate)
