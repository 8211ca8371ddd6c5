"""Robots, gaits and problems shared by the tests of planners."""

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from quadlab.gaits.gait import GaitConfig, contact_schedule, stride_times
from quadlab.geometry.rotations import Array
from quadlab.planners.command import GoalCommand, PerStrideCommand, waypoints
from quadlab.planners.planner import PlanningOutcome
from quadlab.planners.problem import PlanningModel, PlanningProblem, PlanStart
from quadlab.planners.vertex_zmp.planner import VertexZmpPlanner

CONF = Path(__file__).parents[2] / "conf"

COMMANDS: dict[str, PerStrideCommand | GoalCommand] = {
    "forward": PerStrideCommand(kind="per_stride", x_m=0.2, y_m=0.0, yaw_deg=0.0),
    "sideways": PerStrideCommand(kind="per_stride", x_m=0.0, y_m=0.08, yaw_deg=0.0),
    "turn": PerStrideCommand(kind="per_stride", x_m=0.1, y_m=0.0, yaw_deg=20.0),
    "in_place": PerStrideCommand(kind="per_stride", x_m=0.0, y_m=0.0, yaw_deg=0.0),
    "diagonal": GoalCommand(kind="goal", x_m=0.3, y_m=0.12, yaw_deg=0.0),
}
DURATIONS_S = {"trot": 3.0, "walk": 12.0, "stand": 3.0}  # two strides (three of standing)


def load(path: str) -> Any:
    return yaml.safe_load((CONF / path).read_text())


def rectangle(length: float, width: float) -> Array:
    return np.array([[length, width], [length, -width], [-length, width], [-length, -width]])


MODELS = {
    "anymal": PlanningModel(0.47, rectangle(0.28, 0.20), np.array([0.20, 0.10])),
    "hyq": PlanningModel(0.58, rectangle(0.37, 0.27), np.array([0.20, 0.15])),
}


def gait(name: str) -> GaitConfig:
    return GaitConfig(**load(f"gait/{name}.yaml"))


def standing(model: PlanningModel, velocity: Array | None = None) -> PlanStart:
    feet = np.column_stack([model.nominal_feet, np.zeros(4)])
    return PlanStart(np.zeros(2), np.zeros(2) if velocity is None else velocity, 0.0, feet)


def problem(
    robot: str, gait_name: str, command: PerStrideCommand | GoalCommand, duration_s: float | None = None
) -> PlanningProblem:
    model, duration = MODELS[robot], duration_s or DURATIONS_S[gait_name]
    times = stride_times(gait(gait_name), duration)
    return PlanningProblem(
        start=standing(model),
        waypoints=waypoints(command, times, np.zeros(3), duration),
        schedule=contact_schedule(gait(gait_name), duration),
        model=model,
    )


def planner(**changes: Any) -> VertexZmpPlanner:
    return VertexZmpPlanner(VertexZmpPlanner.Config.model_validate({**load("planner/vertex_zmp.yaml"), **changes}))


def plan(problem: PlanningProblem, **changes: Any) -> PlanningOutcome:
    vertex_zmp = planner(**changes)
    return vertex_zmp.solve(vertex_zmp.build(problem))


@lru_cache
def solved(robot: str, gait_name: str, command: str) -> PlanningOutcome:
    return plan(problem(robot, gait_name, COMMANDS[command]))
