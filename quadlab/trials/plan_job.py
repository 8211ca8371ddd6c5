"""Planning without a trial: the plan that the trial with the same configuration would follow, as files."""

from dataclasses import dataclass
from pathlib import Path

from threadpoolctl import threadpool_limits

from quadlab.planners.plan_io import save_plan
from quadlab.planners.planner import PlanningOutcome, solved
from quadlab.robots.model import load_robot
from quadlab.simulation.simulator import Simulator
from quadlab.trials.config import RunOptions, TrialConfig
from quadlab.trials.files import write_text
from quadlab.trials.identity import trial_id
from quadlab.trials.job import CONFIG_FILE
from quadlab.trials.observer import Observer
from quadlab.trials.planning import build_planner, planning_problem

PLAN_FILE = "plan.npz"


@dataclass(frozen=True)
class PlanJobOutcome:
    """What came of planning alone.

    Attributes:
        directory: where the files are.
        outcome: of the planner.
    """

    directory: Path
    outcome: PlanningOutcome


def plan_directory(config: TrialConfig, options: RunOptions) -> Path:
    """Return ``<results_dir>/<tag>/plan_<trial_id>``."""
    return Path(options.results_dir) / config.tag / f"plan_{trial_id(config)}"


def run_plan_job(config: TrialConfig, options: RunOptions) -> PlanJobOutcome:
    """Plan from the state in which the trial would begin and leave ``config.yaml`` and ``plan.npz`` in its directory.

    An older plan in the directory is replaced, or removed if there is none now.

    Raises:
        QuadlabError: if the configuration names something that does not exist.
    """
    directory = plan_directory(config, options)
    with threadpool_limits(1):
        robot = load_robot(config.robot)
        simulator = Simulator(robot, config.scenario, config.simulation, config.seed)
        state = Observer(config, robot, simulator).observe(simulator.reset()).state
        planner = build_planner(config)
        planner.prepare()
        outcome = solved(planner, planning_problem(config, robot, state))
    write_text(directory / CONFIG_FILE, config.to_yaml())
    (directory / PLAN_FILE).unlink(missing_ok=True)
    if outcome.plan is not None:
        save_plan(outcome.plan, directory / PLAN_FILE)
    return PlanJobOutcome(directory, outcome)
