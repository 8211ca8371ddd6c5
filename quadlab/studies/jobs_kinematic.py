"""The kinematic planner alone, from the nominal stance: how it converges, what it costs and how long it takes."""

from collections.abc import Sequence
from pathlib import Path
from statistics import median

from threadpoolctl import threadpool_limits

from quadlab.errors import ConfigurationError
from quadlab.planners.kinematic_sqp.config import KinematicSqpConfig
from quadlab.planners.kinematic_sqp.planner import KinematicSqpPlanner
from quadlab.planners.kinematic_sqp.sqp import Minimum, minimise, objective_history
from quadlab.planners.planner import PlanningStatus
from quadlab.robots.model import load_robot
from quadlab.studies.jobs import composes, current_commit, study_job
from quadlab.studies.rows import FAILURE, Row
from quadlab.trials.composer import Composer
from quadlab.trials.config import TrialConfig
from quadlab.trials.planning import planning_problem

REPETITIONS = 7
"""Of building and solving, for the medians of the wall times."""


@study_job("kinematic_cycles", check=lambda overrides, composer: kinematic_config(composes(overrides, composer)))
def kinematic_cycles_row(overrides: Sequence[str], _: Path, composer: Composer) -> Row:
    """Minimise from the nominal stance and return costs by objective, totals by iteration and times as a row.

    The minimum is not checked as a plan: cycles without a stance after them end in motion.
    """
    config = composes([*overrides, "tag=cycles"], composer)
    planner_config = kinematic_config(config)
    robot = load_robot(config.robot)
    problem = planning_problem(config, robot, robot.nominal_state())
    builds_ms, solves_ms = [], []
    with threadpool_limits(1):
        for _repetition in range(REPETITIONS):
            built = KinematicSqpPlanner(planner_config).build(problem)
            minimum = minimise(built.program, planner_config.sqp)
            builds_ms.append(built.build_ms)
            solves_ms.append(minimum.solve_ms)
    return {
        "status": (PlanningStatus.SOLVED if minimum.converged else PlanningStatus.SOLVER_LIMIT).value,
        FAILURE: minimum.reason,
        "robot": config.robot.name,
        "gait": config.gait.name,
        "planner": config.planner.name,
        "iterations": len(minimum.steps),
        "build_ms": median(builds_ms),
        "solve_ms": median(solves_ms),
        **costs(minimum),
        "commit": current_commit(),
    }


def kinematic_config(config: TrialConfig) -> KinematicSqpConfig:
    """Return the planner's settings.

    Raises:
        ConfigurationError: if it is another planner.
    """
    if not isinstance(config.planner, KinematicSqpConfig):
        raise ConfigurationError(f"planner: '{config.planner.name}' has no objectives; expected kinematic_sqp")
    return config.planner


def costs(minimum: Minimum) -> dict[str, float]:
    """Return the cost of each objective, their sum, ``total``, and that of the guess and after each iteration."""
    objectives = {f"cost_{name}": float(value) for name, value in minimum.history[-1].items()}
    totals = [float(value) for value in objective_history(minimum)]
    return {**objectives, "total": totals[-1], **{f"total_{k}": value for k, value in enumerate(totals)}}
