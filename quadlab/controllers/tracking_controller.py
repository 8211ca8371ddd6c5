"""The controller: measured state and plan to reference, reference to torques."""

import time
from typing import Any

import numpy as np

from quadlab.configuration import part_of
from quadlab.controllers.controller_config import TrackingControllerConfig
from quadlab.controllers.hierarchy import HierarchyError
from quadlab.controllers.joint_reference import driven_command
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.resolver import Resolution, Resolver, unsolved
from quadlab.controllers.telemetry import ControlTelemetry
from quadlab.controllers.tick_report import describe_tick
from quadlab.controllers.tracking.handover import PlanProgress
from quadlab.controllers.tracking.tracker import MotionTracker
from quadlab.errors import QuadlabError
from quadlab.planners.plan import MotionPlan
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import JOINT_COUNT
from quadlab.robots.model import RobotModel
from quadlab.robots.state import JointCommand, RobotState


def build_controller(config: Any, robot: RobotModel) -> "TrackingController":
    """Return the controller that ``config``, of any registered kind, describes."""
    resolver: Any = part_of("controller", config)
    return TrackingController(config, robot, resolver(config))


class TrackingController:
    """Follows one plan at a time with one way to resolve references into torques."""

    def __init__(self, config: TrackingControllerConfig, robot: RobotModel, resolver: Resolver) -> None:
        self.config = config
        self.robot = robot
        self.resolver = resolver
        self.period_s = 1.0 / config.rate_hz
        self.level_names, self.limit_names = resolver.level_names, resolver.limit_names
        self.fallbacks = 0
        self._tracker: MotionTracker | None = None
        self._start_s = 0.0
        self._torques = np.zeros(JOINT_COUNT)

    def start(self, plan: MotionPlan, state: RobotState) -> None:
        """Begin to follow ``plan``, whose time 0 is the time of ``state``."""
        kinematics = self.robot.kinematics(state)
        self._start_s = state.time_s
        self._tracker = MotionTracker(self.config.tracking, self.robot, self.period_s, plan, kinematics)

    def progress(self, state: RobotState) -> PlanProgress:
        """Return how far the plan has been followed: what a new plan has to begin from.

        Raises:
            QuadlabError: if no plan was started.
        """
        return self._started().progress(state.time_s - self._start_s, self.robot.kinematics(state))

    def replace_plan(self, plan: MotionPlan, state: RobotState) -> None:
        """Go on with ``plan``, made from the ``progress`` at ``state``; contacts and terrain are kept.

        Raises:
            QuadlabError: if no plan was started.
        """
        self._started().replace_plan(plan, state.time_s - self._start_s, self.robot.kinematics(state))
        self._start_s = state.time_s

    def tick(self, state: RobotState) -> tuple[JointCommand, ControlTelemetry]:
        """Return torques for the next control period.

        Raises:
            QuadlabError: if no plan was started.
        """
        tracker = self._started()
        began = time.perf_counter()
        kinematics = self.robot.kinematics(state)
        modelled = time.perf_counter()
        tracked = tracker.update(state.time_s - self._start_s, kinematics, state.foot_forces_in_world[:, 2])
        referenced = time.perf_counter()
        accepted = self._accept(self._resolve(kinematics, tracked.reference))
        solved = time.perf_counter()
        telemetry = describe_tick(
            tracked,
            kinematics,
            accepted,
            fallbacks=self.fallbacks,
            timings_us=(1e6 * (modelled - began), 1e6 * (referenced - modelled), 1e6 * (solved - referenced)),
        )
        return self._command(kinematics, tracked.reference, accepted), telemetry

    def _started(self) -> MotionTracker:
        if self._tracker is None:
            raise QuadlabError("controller: no plan to follow; call start(plan, state) first")
        return self._tracker

    def _resolve(self, kinematics: Kinematics, reference: ControlReference) -> Resolution:
        """Return the resolver's answer; numbers that no method can work with are a tick without one."""
        try:
            return self.resolver.resolve(kinematics, reference, self._torques)
        except (HierarchyError, np.linalg.LinAlgError) as error:
            return unsolved(self.level_names, str(error))

    def _accept(self, resolution: Resolution) -> Resolution:
        """Take the resolver's answer, or count it and keep the last torques, within the limits, if it did not finish.

        Nothing else of an answer that is not used is kept: no forces are expected, and drives are off.
        """
        if resolution.solved:
            self._torques = resolution.torques
            return resolution
        self.fallbacks += 1
        limits = self.robot.torque_limits
        kept = unsolved(self.level_names, resolution.reason)
        return kept._replace(torques=np.clip(self._torques, -limits, limits), iterations=resolution.iterations)

    def _command(self, kinematics: Kinematics, reference: ControlReference, resolution: Resolution) -> JointCommand:
        if self.config.joint_pd is None or not resolution.solved:
            return JointCommand(resolution.torques)
        return driven_command(self.config.joint_pd, kinematics, reference, resolution)
