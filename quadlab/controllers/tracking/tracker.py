"""From plan and measured state to the reference of one tick."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from quadlab.constants import GRAVITY
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.telemetry import LegMode
from quadlab.controllers.tracking.alignment import (
    PlanarPose,
    SmoothedAlignment,
    base_alignment,
    feet_alignment,
    identity_alignment,
)
from quadlab.controllers.tracking.balance import Balance
from quadlab.controllers.tracking.config import Alignment, TorsoReference, TrackingConfig
from quadlab.controllers.tracking.contact_machine import start_contacts
from quadlab.controllers.tracking.feet import FootPlanner
from quadlab.controllers.tracking.force_ramp import normal_force_limit, ramp_duration
from quadlab.controllers.tracking.handover import PlanProgress, feet_in_progress
from quadlab.controllers.tracking.plan_clock import PlanClock
from quadlab.controllers.tracking.torso import ground_axes
from quadlab.controllers.tracking.torso_motion import (
    Ground,
    NominalStance,
    planned_torso,
    torso_under_com,
)
from quadlab.estimation.terrain_plane import TerrainPlane, blend, fit_plane
from quadlab.geometry.pose_curve import PoseMotion
from quadlab.geometry.rotations import Array, yaw_of
from quadlab.planners.capture_point import capture_point
from quadlab.planners.plan import MotionPlan, PlanSample
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import LEG_COUNT
from quadlab.robots.model import RobotModel


class TrackedTick(NamedTuple):
    """The outcome of one tick of the tracker.

    Attributes:
        reference: what the tasks shall follow.
        sample: the plan at this tick, in plan frame.
        plan_time_s: where the plan was looked up in [s]; goes on if the plan is replaced.
        torso_alignment: of the torso's reference.
        plan_pose_in_world: x, y in [m] and yaw in [rad] of the frame of the first plan, (3,).
        terrain: plane under the robot, written about the CoM.
        modes: of the legs.
        events: one line each.
    """

    reference: ControlReference
    sample: PlanSample
    plan_time_s: float
    torso_alignment: PlanarPose
    plan_pose_in_world: Array
    terrain: TerrainPlane
    modes: tuple[LegMode, ...]
    events: tuple[str, ...]


class MotionTracker:
    """Keeps contacts, alignment and terrain from tick to tick and turns a plan into references."""

    def __init__(
        self, config: TrackingConfig, robot: RobotModel, period_s: float, plan: MotionPlan, start: Kinematics
    ) -> None:
        self.config = config
        self.robot = robot
        self.period_s = period_s
        self.plan = plan
        self._weight = robot.mass * GRAVITY
        self._base_height = float(robot.nominal_state().position_base_in_world[2])
        self._stance = NominalStance(tuple(robot.nominal_com_in_base[:2].tolist()), self._base_height)
        self._contacts = start_contacts(config.contact, plan.schedule, self._weight, start.foot_positions)
        self._alignment = SmoothedAlignment(config.alignment.time_constant_s, identity_alignment())
        self._terrain = fit_plane(start.foot_positions, start.com_position[:2])
        self._clock = PlanClock(math.sqrt(robot.nominal_com_height / GRAVITY))
        self._began_s = 0.0
        self._first_frame = np.zeros(3)
        self._feet = FootPlanner(
            config.swing,
            self._base_height,
            config.contact.search_speed_mps,
            robot.nominal_feet_in_com,
            plan.footholds,
        )

    def progress(self, time_s: float, kinematics: Kinematics) -> PlanProgress:
        """Return how far the plan has been followed at ``time_s`` since its start, in [s]."""
        plan_time_s = time_s - self._clock.waited_s
        feet, standing, regular = feet_in_progress(self._contacts, plan_time_s, kinematics.foot_positions)
        pose = self._alignment.current.pose(self._first_frame)
        return PlanProgress(self._began_s + plan_time_s, pose, feet, standing, regular)

    def replace_plan(self, plan: MotionPlan, time_s: float, kinematics: Kinematics) -> None:
        """Follow another plan from now on, which was made from the ``progress`` of this moment.

        Its frame is the world as it is now and its time 0 is ``time_s`` since the start of the old plan, in [s]:
        times of later updates count from now. Contacts, terrain and force ramps go on.
        """
        elapsed_s = time_s - self._clock.waited_s
        self._first_frame = self._alignment.current.pose(self._first_frame)
        self._began_s += elapsed_s
        self._clock.waited_s = 0.0
        self._contacts.follow(plan.schedule, elapsed_s, kinematics.foot_positions)
        self._alignment = SmoothedAlignment(self.config.alignment.time_constant_s, identity_alignment())
        self._feet = replace(self._feet, footholds=plan.footholds)
        self.plan = plan

    def update(self, time_s: float, kinematics: Kinematics, normal_forces: Array) -> TrackedTick:
        """Return references for this tick.

        Args:
            time_s: time since the plan's start in [s].
            kinematics: of the measured state.
            normal_forces: measured under the feet, (4,) in [N].
        """
        waits = self.config.contact.freeze_plan_while_searching and self._contacts.searching
        self._clock.advance(waits, self.period_s)
        plan_time_s = time_s - self._clock.waited_s
        sample = self.plan.at(plan_time_s)
        events = self._contacts.update(
            plan_time_s,
            self.period_s,
            kinematics.foot_positions,
            normal_forces,
            lambda: self._balance(sample, kinematics),
        )
        stance_points = self._contacts.stance_points
        self._update_terrain(stance_points, kinematics)
        raw = self._raw_alignment(self.config.alignment.torso, sample, stance_points, kinematics)
        torso = self._alignment.update(raw, sample.com_position[:2], self.period_s)
        return TrackedTick(
            reference=self._reference(plan_time_s, sample, torso, stance_points, kinematics),
            sample=sample,
            plan_time_s=self._began_s + plan_time_s,
            torso_alignment=torso,
            plan_pose_in_world=torso.pose(self._first_frame),
            terrain=self._terrain,
            modes=tuple(leg.mode for leg in self._contacts.legs),
            events=tuple(events),
        )

    def _balance(self, sample: PlanSample, kinematics: Kinematics) -> Balance:
        alignment, height = self._alignment.current, self.robot.nominal_com_height
        position, velocity = alignment.position(sample.com_position[:2]), alignment.vector(sample.com_velocity[:2])
        return Balance(
            kinematics.foot_positions[:, :2],
            capture_point(kinematics.com_position[:2], kinematics.com_velocity[:2], height),
            capture_point(position, self._clock.rate * velocity, height),
        )

    def _update_terrain(self, stance_points: Array, kinematics: Kinematics) -> None:
        newest = fit_plane(stance_points, kinematics.com_position[:2])
        share = self.period_s / (self.config.torso.terrain_time_constant_s + self.period_s)
        self._terrain = blend(self._terrain, newest, share)

    def _raw_alignment(
        self, kind: Alignment, sample: PlanSample, stance_points: Array, kinematics: Kinematics
    ) -> PlanarPose:
        if kind is Alignment.NONE:
            return identity_alignment()
        if kind is Alignment.BASE:
            heading = yaw_of(kinematics.base_rotation)
            return base_alignment(sample.com_position[:2], sample.yaw, kinematics.com_position[:2], heading)
        planned = [
            points[min(leg.foothold, len(points) - 1)]
            for points, leg in zip(self.plan.footholds, self._contacts.legs, strict=True)
        ]
        return feet_alignment(np.array(planned)[:, :2], stance_points[:, :2])

    def _reference(
        self,
        plan_time_s: float,
        sample: PlanSample,
        torso: PlanarPose,
        stance_points: Array,
        kinematics: Kinematics,
    ) -> ControlReference:
        rate, rate_change = clock = self._clock.rate, self._clock.rate_change
        com_change = rate**2 * sample.com_acceleration[:2] + rate_change * sample.com_velocity[:2]
        com_position, com_velocity = torso.position(sample.com_position[:2]), torso.vector(sample.com_velocity[:2])
        com = (com_position, rate * com_velocity, torso.vector(com_change))
        base = self._base_motion(plan_time_s, sample, torso, com, kinematics)
        footholds = self._footholds_alignment(sample, torso, stance_points, kinematics)
        feet = self._feet.motions(self._contacts.legs, plan_time_s, clock, footholds, com[1], kinematics, self._terrain)
        return ControlReference(
            com_position=com[0],
            com_velocity=com[1],
            com_acceleration=com[2],
            base_position=base.position[:2],
            base_height=float(base.position[2]),
            base_velocity=base.velocity,
            base_acceleration=base.acceleration,
            base_rotation=base.rotation,
            base_angular_velocity=base.angular_velocity,
            base_angular_acceleration=base.angular_acceleration,
            foot_positions=feet[0],
            foot_velocities=feet[1],
            foot_accelerations=feet[2],
            stance=self._contacts.stance,
            normal_force_limits=np.array([self._force_limit(leg, plan_time_s) for leg in range(LEG_COUNT)]),
            torque_limits=self.robot.torque_limits,
            joint_position_limits=self.robot.joint_position_limits,
            weight=self._weight,
            standing_height=self._base_height,
            ground_axes=ground_axes(sample.yaw + torso.yaw, self._terrain),
        )

    def _base_motion(
        self,
        plan_time_s: float,
        sample: PlanSample,
        torso: PlanarPose,
        com: tuple[Array, Array, Array],
        kinematics: Kinematics,
    ) -> PoseMotion:
        """Return what the base shall do; ``com`` as in ``torso_under_com``."""
        config, clock = self.config.torso, (self._clock.rate, self._clock.rate_change)
        height = self._terrain.height_at(kinematics.base_position[:2])
        ground = Ground(self._terrain, height, config.slope_following)
        if config.reference is TorsoReference.BASE and self.plan.base_curve is not None:
            return planned_torso(self.plan.base_curve.motion(plan_time_s), torso, clock, ground)
        turning = (sample.yaw + torso.yaw, clock[0] * sample.yaw_rate)
        return torso_under_com(com, turning, ground, self._stance)

    def _footholds_alignment(
        self, sample: PlanSample, torso: PlanarPose, stance_points: Array, kinematics: Kinematics
    ) -> PlanarPose:
        """Return the alignment of footholds: smoothed like the torso's if it jumps at new footholds, else as it is."""
        kind = self.config.alignment.swing
        if kind is Alignment.FEET and self.config.alignment.torso is Alignment.FEET:
            return torso
        return self._raw_alignment(kind, sample, stance_points, kinematics)

    def _force_limit(self, leg: int, plan_time_s: float) -> float:
        state, schedule, ramp = self._contacts.legs[leg], self.plan.schedule, self.config.force_ramp
        if state.mode is not LegMode.STANCE:
            return 0.0
        swings = schedule.swings[leg]
        lift_off_s = swings[state.foothold].start_s if state.foothold < len(swings) else math.inf
        since_s, until_s = plan_time_s - state.touch_down_s, lift_off_s - plan_time_s
        ramp_s = ramp_duration(ramp, schedule, leg, state.foothold, max(state.touch_down_s, -self._began_s))
        return normal_force_limit(ramp, self._weight, ramp_s, since_s, until_s)
