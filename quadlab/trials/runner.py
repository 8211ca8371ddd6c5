"""One trial: plan, then close the loop between controller and simulation, record everything, judge the outcome."""

import math
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quadlab.controllers.controller import Controller
from quadlab.controllers.tracking_controller import build_controller
from quadlab.planners.plan import MotionPlan
from quadlab.planners.planner import solved
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.state import JointCommand, RobotState
from quadlab.simulation.geoms import describe_geoms
from quadlab.simulation.simulator import Simulator
from quadlab.trials.config import TrialConfig
from quadlab.trials.estimation_metrics import EstimationMetrics
from quadlab.trials.failure import fall_reason, progress_reason
from quadlab.trials.identity import trial_id
from quadlab.trials.manifest import MANIFEST_FILE
from quadlab.trials.metrics import TrialMetrics
from quadlab.trials.observer import Observer, as_it_happened
from quadlab.trials.planning import build_planner, planning_problem
from quadlab.trials.progress import TrialProgress
from quadlab.trials.recording.record import BodyPoses, TickRecord
from quadlab.trials.recording.recorder import Attachments, EventLevel, TrialRecorder
from quadlab.trials.recording.topics import CONFIG_ATTACHMENT, LOG_FILE, URDF_ATTACHMENT
from quadlab.trials.replanning import Replanner
from quadlab.trials.result import TrialResult, TrialStatus


@dataclass(frozen=True)
class Ending:
    """How a trial ended, and one line why."""

    status: TrialStatus
    reason: str


def run_trial(config: TrialConfig, directory: Path, progress: TrialProgress) -> TrialResult:
    """Run one trial and leave its log in ``directory``.

    Args:
        config: the trial.
        directory: exists; ``config.yaml`` and ``manifest.json`` in it are attached to the log.
        progress: told about the simulated time.

    Returns:
        The result; a fall or a failed plan is a status, not an exception.
    """
    robot = load_robot(config.robot)
    simulator = Simulator(robot, config.scenario, config.simulation, config.seed)
    observer = Observer(config, robot, simulator)
    planner = build_planner(config)
    planner.prepare()
    problem = planning_problem(config, robot, observer.observe(simulator.reset()).state)
    outcome = solved(planner, problem)
    if outcome.plan is None:
        return _result(config, Ending(TrialStatus.PLANNING_FAILED, f"{outcome.status}: {outcome.reason}"), {})
    controller = build_controller(config.controller, robot)
    replanner = Replanner(config.replanning, robot, planner, problem)
    loop = ClosedLoop(config, robot, simulator, observer, controller, outcome.plan, replanner)
    progress.start(f"{robot.name} {config.gait.name}", config.duration_s)
    with _recorder(config, directory, robot, simulator, controller, outcome.plan) as recorder:
        ending = loop.run(recorder, progress)
    progress.finish(ending.status.value)
    report = outcome.plan.report
    planning = {
        "planning_build_ms": report.build_ms,
        "planning_solve_ms": report.solve_ms,
        "planning_iterations": report.iterations,
    }
    metrics = loop.metrics.summary() | loop.estimation.summary() | replanner.summary()
    return _result(config, ending, planning | metrics | {"real_time_factor": loop.real_time_factor})


class ClosedLoop:
    """Controller and simulation, tick by tick, until the end or a failure."""

    def __init__(
        self,
        config: TrialConfig,
        robot: RobotModel,
        simulator: Simulator,
        observer: Observer,
        controller: Controller,
        plan: MotionPlan,
        replanner: Replanner,
    ) -> None:
        self.config = config
        self.plan = plan
        error = config.simulation.model_error
        self.metrics = TrialMetrics(
            robot.mass + error.payload_kg,
            robot.torque_limits,
            controller.period_s,
            controller.limit_names,
            error.torque_scale,
        )
        self.estimation = EstimationMetrics()
        self.real_time_factor = 0.0
        self._robot = robot
        self._simulator = simulator
        self._observer = observer
        self._controller = controller
        self._replanner = replanner
        self._standing_height = float(robot.nominal_state().position_base_in_world[2])

    def run(self, recorder: TrialRecorder, progress: TrialProgress) -> Ending:
        """Run to the end and return how it ended."""
        began = time.perf_counter()
        state = self._simulator.read()
        self._controller.start(self.plan, self._observer.observe(state).state)
        ending: Ending | None = None
        for _ in range(round(self.config.duration_s / self._controller.period_s)):
            ending = self._tick(state, recorder)
            state = self._simulator.read()
            if ending is not None:
                break
            progress.advance(state.time_s, "running")
        self.real_time_factor = state.time_s / (time.perf_counter() - began)
        ending = ending or self._judge()
        level = EventLevel.INFO if ending.status is TrialStatus.COMPLETED else EventLevel.ERROR
        recorder.event(state.time_s, f"{ending.status}: {ending.reason}", level)
        return ending

    def _tick(self, state: RobotState, recorder: TrialRecorder) -> Ending | None:
        if not state.is_finite():
            return Ending(TrialStatus.DIVERGED, f"the state is not finite at {state.time_s:.3f} s")
        estimate = self._observer.observe(state)
        replanned = self._replanner.update(self._controller, estimate.state)
        command, telemetry = self._controller.tick(estimate.state)
        if replanned:
            telemetry = telemetry._replace(events=(replanned, *telemetry.events))
        poses = BodyPoses(*self._simulator.body_poses()) if recorder.draws(state.time_s) else None
        pushes = tuple(self._simulator.active_pushes())
        self._simulator.advance(command, self._controller.period_s)
        applied = JointCommand(self._simulator.applied_torques)
        recorder.record(TickRecord(state, applied, telemetry, pushes, estimate), poses)
        self.estimation.add(state, estimate, telemetry)
        if estimate.report is not None:
            telemetry = as_it_happened(telemetry, estimate, state, self._robot.points(state))
        self.metrics.add(state, applied, telemetry, self._simulator.integration_state())
        fallen = fall_reason(self.config.failure, state, telemetry, self._standing_height)
        return Ending(TrialStatus.FELL, fallen) if fallen else None

    def _judge(self) -> Ending:
        start, end = self.plan.com(0.0), self.plan.com(self.plan.duration_s)
        planned = math.dist(start[:2], end[:2])
        stuck = progress_reason(self.config.failure, self.metrics.distance_m, planned)
        if stuck:
            return Ending(TrialStatus.NO_PROGRESS, stuck)
        return Ending(TrialStatus.COMPLETED, f"upright after {self.config.duration_s:g} s")


def _recorder(
    config: TrialConfig,
    directory: Path,
    robot: RobotModel,
    simulator: Simulator,
    controller: Controller,
    plan: MotionPlan,
) -> TrialRecorder:
    files: Attachments = {
        CONFIG_ATTACHMENT: ("text/yaml", config.to_yaml().encode()),
        URDF_ATTACHMENT: ("application/xml", robot.urdf_text.encode()),
    }
    manifest = directory / MANIFEST_FILE
    if manifest.is_file():
        files = {**files, MANIFEST_FILE: ("application/json", manifest.read_bytes())}
    words = {"trial_id": trial_id(config), "robot": robot.name, "gait": config.gait.name}
    return TrialRecorder(
        directory / LOG_FILE,
        config.log,
        level_names=controller.level_names,
        plan=plan,
        geoms=describe_geoms(simulator.model),
        attachments=files,
        metadata=words,
        estimates=config.estimator.kind != "truth",
    )


def _result(config: TrialConfig, ending: Ending, numbers: dict[str, Any]) -> TrialResult:
    return TrialResult(
        trial_id=trial_id(config),
        status=ending.status,
        status_reason=ending.reason,
        robot=config.robot.name,
        gait=config.gait.name,
        planner=config.planner.name,
        controller=config.controller.name,
        estimator=config.estimator.kind,
        scenario=config.scenario.name,
        seed=config.seed,
        duration_s=config.duration_s,
        **numbers,
    )
