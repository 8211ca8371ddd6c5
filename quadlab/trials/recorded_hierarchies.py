"""Hierarchies as they come up in closed loop: every so many ticks of a trial, with the start of the solver."""

from collections.abc import Callable, Sequence
from typing import Any

from quadlab.configuration import part_of
from quadlab.controllers.decision_space import DecisionSpace
from quadlab.controllers.hierarchical import HierarchicalResolver
from quadlab.controllers.hierarchy import Level, StackedLevels, unstack
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.resolver import Resolution
from quadlab.controllers.tracking_controller import TrackingController
from quadlab.errors import QuadlabError
from quadlab.geometry.rotations import Array
from quadlab.planners.planner import solved
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.model import load_robot
from quadlab.simulation.simulator import Simulator
from quadlab.trials.config import TrialConfig
from quadlab.trials.failure import fall_reason
from quadlab.trials.planning import build_planner, planning_problem

HierarchyHandler = Callable[[Sequence[Level], Array], None]
"""Given levels and start, (n,)."""


class RecordingResolver:
    """A hierarchical resolver that hands the levels of every ``stride``-th tick to ``handler`` and then solves them."""

    def __init__(self, resolver: HierarchicalResolver, stride: int, handler: HierarchyHandler) -> None:
        self.level_names, self.limit_names = resolver.level_names, resolver.limit_names
        self._resolver = resolver
        self._stride = stride
        self._handler = handler
        self._ticks = 0

    def resolve(self, kinematics: Kinematics, reference: ControlReference, last_torques: Array) -> Resolution:
        """Return what the resolver behind it returns."""
        if self._ticks % self._stride == 0:
            space, levels = self._resolver.assemble(kinematics, reference)
            self._hand_over(space, levels, last_torques)
        self._ticks += 1
        return self._resolver.resolve(kinematics, reference, last_torques)

    def _hand_over(self, space: DecisionSpace, levels: StackedLevels, last_torques: Array) -> None:
        self._handler(unstack(levels, self.level_names), space.nearest(last_torques))


def record_hierarchies(config: TrialConfig, stride: int, handler: HierarchyHandler) -> str:
    """Run the closed loop of a trial on its true state and return how it ended; nothing is logged.

    Args:
        config: with a hierarchical controller, without replanning.
        stride: every so many ticks the hierarchy is handed over.
        handler: given each of these hierarchies.

    Raises:
        QuadlabError: if there is no plan or no hierarchy.
    """
    robot = load_robot(config.robot)
    simulator = Simulator(robot, config.scenario, config.simulation, config.seed)
    planner = build_planner(config)
    outcome = solved(planner, planning_problem(config, robot, simulator.read()))
    if outcome.plan is None:
        raise QuadlabError(f"no plan: {outcome.status}: {outcome.reason}")
    resolver: Any = part_of("controller", config.controller)(config.controller)
    if not isinstance(resolver, HierarchicalResolver):
        raise QuadlabError(f"controller {config.controller.name}: expected one of kind hierarchical")
    recording = RecordingResolver(resolver, stride, handler)
    controller = TrackingController(resolver.config, robot, recording)
    standing_height = float(robot.nominal_state().position_base_in_world[2])
    state = simulator.read()
    controller.start(outcome.plan, state)
    for _ in range(round(config.duration_s / controller.period_s)):
        command, telemetry = controller.tick(state)
        fallen = fall_reason(config.failure, state, telemetry, standing_height)
        if fallen:
            return fallen
        simulator.advance(command, controller.period_s)
        state = simulator.read()
        if not state.is_finite():
            return f"diverged at {state.time_s:.2f} s"
    return "completed"
