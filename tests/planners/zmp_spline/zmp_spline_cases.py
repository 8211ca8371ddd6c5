"""The ZMP spline planner with its shipped settings, and walks for it."""

from functools import lru_cache
from typing import Any

import yaml
from planning_cases import COMMANDS, problem

from quadlab.paths import CONF_DIR
from quadlab.planners.planner import PlanningOutcome
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.zmp_spline.planner import ZmpSplinePlanner

SETTINGS: dict[str, Any] = yaml.safe_load((CONF_DIR / "planner/zmp_spline.yaml").read_text())
MARGIN = float(SETTINGS["support_margin_m"])


def spline_planner(**changes: Any) -> ZmpSplinePlanner:
    return ZmpSplinePlanner(ZmpSplinePlanner.Config.model_validate({**SETTINGS, **changes}))


def spline_plan(asked: PlanningProblem, **changes: Any) -> PlanningOutcome:
    planner = spline_planner(**changes)
    return planner.solve(planner.build(asked))


def walk(robot: str = "anymal", command: str = "forward", duration_s: float | None = None) -> PlanningProblem:
    return problem(robot, "walk", COMMANDS[command], duration_s)


@lru_cache
def solved_walk(robot: str = "anymal", command: str = "forward") -> PlanningOutcome:
    return spline_plan(walk(robot, command))
