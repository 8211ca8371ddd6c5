"""The kinematic planner alone, from the nominal stance: how it converges, what it costs and how long it takes."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np
from threadpoolctl import threadpool_limits

from quadlab.errors import ConfigurationError
from quadlab.planners.kinematic_sqp.config import KinematicSqpConfig
from quadlab.planners.kinematic_sqp.planner import KinematicSqpPlanner
from quadlab.planners.plan import PlanReport
from quadlab.planners.plan_io import save_plan
from quadlab.planners.planner import PlanningOutcome
from quadlab.planners.problem import PlanningProblem
from quadlab.robots.model import load_robot
from quadlab.studies.jobs import DIRECTORY, FAILURE, Row, current_commit, plan_numbers, study_job
from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions, TrialConfig
from quadlab.trials.plan_job import PLAN_FILE, plan_directory
from quadlab.trials.planning import planning_problem

REPETITIONS = 7
"""Of building and solving, for the medians of the wall times."""


@study_job("kinematic_cycles")
def kinematic_cycles_row(overrides: Sequence[str], folder: Path) -> Row:
    """Plan from the nominal stance and return costs by objective, totals by iteration and times as a row."""
    config = compose_trial([*overrides, "tag=cycles"])
    problem = standing_problem(config)
    with threadpool_limits(1):
        runs = [timed_plan(kinematic_config(config), problem) for _ in range(REPETITIONS)]
    plan = runs[-1].outcome.plan
    row: Row = {
        "status": runs[-1].outcome.status.value,
        FAILURE: runs[-1].outcome.reason,
        "robot": config.robot.name,
        "gait": config.gait.name,
        "planner": config.planner.name,
        "commit": current_commit(),
    }
    if plan is None:
        return row
    directory = plan_directory(config, RunOptions(force=False, results_dir=str(folder)))
    directory.mkdir(parents=True, exist_ok=True)
    save_plan(plan, directory / PLAN_FILE)
    times = {name: median(getattr(run, name) for run in runs) for name in ("build_ms", "solve_ms")}
    place = {DIRECTORY: str(directory.relative_to(folder))}
    return {**row, **place, **plan_numbers(plan), **times, **totals(plan.report)}


def kinematic_config(config: TrialConfig) -> KinematicSqpConfig:
    """Return the planner's settings.

    Raises:
        ConfigurationError: if it is another planner.
    """
    if not isinstance(config.planner, KinematicSqpConfig):
        raise ConfigurationError(
            f"planner: '{config.planner.name}' has no objectives of Table I; expected kinematic_sqp"
        )
    return config.planner


def standing_problem(config: TrialConfig) -> PlanningProblem:
    """Return the problem that begins in the robot's nominal stance, as in Gehring 2017, Sec. IV."""
    robot = load_robot(config.robot)
    return planning_problem(config, robot, robot.nominal_state())


@dataclass(frozen=True)
class TimedPlan:
    """One planning run.

    Attributes:
        outcome: of the planner.
        build_ms, solve_ms: wall times in [ms]; not a number without a plan.
    """

    outcome: PlanningOutcome
    build_ms: float
    solve_ms: float


def timed_plan(config: KinematicSqpConfig, problem: PlanningProblem) -> TimedPlan:
    """Return what a planner that knows nothing of earlier runs makes of ``problem``."""
    planner = KinematicSqpPlanner(config)
    build = planner.build(problem)
    outcome = planner.solve(build)
    return TimedPlan(outcome, build.build_ms, outcome.plan.report.solve_ms if outcome.plan else np.nan)


def totals(report: PlanReport) -> dict[str, float]:
    """Return the objective of the guess, ``total_0``, after every iteration, and at the end, ``total``."""
    objectives = [sum(costs.values()) for costs in report.cost_history]
    return {"total": objectives[-1], **{f"total_{k}": value for k, value in enumerate(objectives)}}
