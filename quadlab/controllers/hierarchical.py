"""Hierarchical whole-body control: strict priorities, solved in the joint torques (Bellicoso 2016; Gehring 2017)."""

import time
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from quadlab.configuration import Positive, StrictModel, register
from quadlab.controllers.hierarchy import HierarchySolution, HierarchyStatus, Level, solve_hierarchy
from quadlab.controllers.reduced_dynamics import ReducedDynamics, reduce_dynamics
from quadlab.controllers.task_levels import LevelConfig, build_task
from quadlab.controllers.telemetry import ControlTelemetry
from quadlab.controllers.tick_report import describe_tick
from quadlab.controllers.tracking.config import TrackingConfig
from quadlab.controllers.tracking.tracker import MotionTracker, TrackedTick
from quadlab.errors import QuadlabError
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import JOINT_COUNT
from quadlab.robots.model import RobotModel
from quadlab.robots.state import JointCommand, RobotState


@register("controller", "hierarchical")
class HierarchicalController:
    """Tracks a plan with levels of tasks; dynamics and contacts stand above all of them."""

    class Config(StrictModel):
        """Priorities, gains and tracking.

        Attributes:
            rate_hz: control rate in [1/s].
            levels: highest priority first; names are unique.
            tracking: everything between plan and tasks.
        """

        kind: Literal["hierarchical"]
        rate_hz: Positive
        levels: Annotated[tuple[LevelConfig, ...], Field(min_length=1)]
        tracking: TrackingConfig

        @model_validator(mode="after")
        def _unique_names(self) -> "HierarchicalController.Config":
            names = [level.name for level in self.levels]
            if len(set(names)) != len(names):
                raise ValueError(f"level names must differ; have {', '.join(names)}")
            return self

    def __init__(self, config: Config, robot: RobotModel) -> None:
        self.config = config
        self.robot = robot
        self.period_s = 1.0 / config.rate_hz
        self.level_names = tuple(level.name for level in config.levels)
        self.fallbacks = 0
        self._levels = [(level.name, [build_task(task) for task in level.tasks]) for level in config.levels]
        self._tracker: MotionTracker | None = None
        self._start_s = 0.0
        self._torques = np.zeros(JOINT_COUNT)

    def start(self, plan: MotionPlan, state: RobotState) -> None:
        """Begin to follow ``plan``, whose time 0 is the time of ``state``."""
        kinematics = self.robot.kinematics(state)
        self._start_s = state.time_s
        self._tracker = MotionTracker(self.config.tracking, self.robot, self.period_s, plan, kinematics)

    def tick(self, state: RobotState) -> tuple[JointCommand, ControlTelemetry]:
        """Return torques for the next control period.

        Raises:
            QuadlabError: if no plan was started.
        """
        if self._tracker is None:
            raise QuadlabError("controller: tick before start; call start(plan, state) first")
        began = time.perf_counter()
        kinematics = self.robot.kinematics(state)
        modelled = time.perf_counter()
        tracked = self._tracker.update(state.time_s - self._start_s, kinematics, state.foot_forces_in_world[:, 2])
        referenced = time.perf_counter()
        dynamics, solution = self._solve(kinematics, tracked)
        torques = self._accept(solution)
        solved = time.perf_counter()
        telemetry = describe_tick(
            tracked,
            kinematics,
            dynamics,
            torques=torques,
            residuals=solution.residual_norms,
            iterations=solution.iterations,
            fallbacks=self.fallbacks,
            timings_us=(1e6 * (modelled - began), 1e6 * (referenced - modelled), 1e6 * (solved - referenced)),
        )
        return JointCommand(torques), telemetry

    def levels(self, kinematics: Kinematics, tracked: TrackedTick, dynamics: ReducedDynamics) -> list[Level]:
        """Return the hierarchy of this tick, written in torques."""
        stacked = []
        for name, tasks in self._levels:
            parts = [dynamics.in_torques(task.rows(kinematics, tracked.reference)) for task in tasks]
            matrix, lower, upper = (np.concatenate(blocks) for blocks in zip(*parts, strict=True))
            stacked.append(Level(name, matrix, lower, upper))
        return stacked

    def _solve(self, kinematics: Kinematics, tracked: TrackedTick) -> tuple[ReducedDynamics, HierarchySolution]:
        dynamics = reduce_dynamics(kinematics, tracked.reference.stance_legs)
        return dynamics, solve_hierarchy(self.levels(kinematics, tracked, dynamics), start=self._torques)

    def _accept(self, solution: HierarchySolution) -> Array:
        """Take the solver's torques, or keep the last ones and count it if it did not finish."""
        if solution.status is HierarchyStatus.SOLVED:
            self._torques = solution.x
        else:
            self.fallbacks += 1
        return self._torques
