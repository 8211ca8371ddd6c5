"""The vertex-ZMP planner on the motions of Winkler 2017, Table I, and on its biped: sizes, times, verdicts."""

from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from quadlab.errors import ConfigurationError
from quadlab.planners.plan_io import plan_to_bytes
from quadlab.planners.planner import PlanningOutcome
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.vertex_zmp.biped import RECTANGULAR_FOOT, biped_problem
from quadlab.planners.vertex_zmp.planner import VertexZmpPlanner
from quadlab.planners.vertex_zmp.table_one import TABLE_ONE, table_one_changes, table_one_problem
from quadlab.studies.jobs import composes, current_commit, plan_numbers, study_job
from quadlab.studies.rows import DIRECTORY, FAILURE, Row
from quadlab.trials.composer import Composer
from quadlab.trials.files import write_bytes
from quadlab.trials.plan_job import PLAN_FILE
from quadlab.trials.problems import suggestion

REPETITIONS = 5
"""Of building and solving, for the medians of the wall times; one more goes before them."""
BIPED = "biped"
BIPED_STEPS, BIPED_GOAL = 4, np.array([0.6, 0.2, 0.3])  # x, y in [m], yaw in [rad]
CASES = {case.name: case for case in TABLE_ONE}


def table_one_options(overrides: Sequence[str]) -> dict[str, str]:
    """Return ``case`` and ``transcription``.

    Raises:
        ConfigurationError: if the overrides are anything else.
    """
    options = dict(override.partition("=")[::2] for override in overrides)
    if set(options) != {"case", "transcription"}:
        raise ConfigurationError(f"job table_one: expected case=... and transcription=..., got {list(overrides)}")
    return options


def check_table_one(overrides: Sequence[str], _: object) -> None:
    """Do nothing if the overrides name a case.

    Raises:
        ConfigurationError: if they do not.
    """
    options = table_one_options(overrides)
    case_problem(options["case"], options["transcription"])


@study_job("table_one", check=check_table_one)
def table_one_row(overrides: Sequence[str], folder: Path, composer: Composer) -> Row:
    """Plan ``case=<column of Table I, or biped>`` in ``transcription=fast|paper``; return sizes and times as a row.

    Raises:
        ConfigurationError: if it is told anything else.
    """
    options = table_one_options(overrides)
    problem, changes = case_problem(options["case"], options["transcription"])
    composed: Any = composes(["planner=vertex_zmp"], composer).planner
    settings = composed.model_dump()
    planner = VertexZmpPlanner(VertexZmpPlanner.Config.model_validate({**settings, **changes}))
    with threadpool_limits(1):
        outcomes = [_built_and_solved(planner, problem) for _ in range(1 + REPETITIONS)][1:]
    last = outcomes[-1][1]
    row: Row = {"status": last.status.value, FAILURE: last.reason, "commit": current_commit()}
    if last.plan is None:
        return row
    directory = folder / "trials" / "_".join(options.values()).replace(" ", "_")
    write_bytes(directory / PLAN_FILE, plan_to_bytes(last.plan))
    times = {
        "build_ms": median(build_ms for build_ms, _ in outcomes),
        "solve_ms": median(outcome.plan.report.solve_ms for _, outcome in outcomes if outcome.plan),
    }
    return {**row, DIRECTORY: str(directory.relative_to(folder)), **plan_numbers(last.plan), **times}


def case_problem(name: str, transcription: str) -> tuple[PlanningProblem, dict[str, object]]:
    """Return a case with the settings of the planner that belong to it.

    Raises:
        ConfigurationError: if there is none of that name.
    """
    if name == BIPED:
        return biped_problem(RECTANGULAR_FOOT, BIPED_STEPS, BIPED_GOAL), {"transcription": transcription}
    if name not in CASES:
        raise ConfigurationError(f"case: unknown '{name}'; {suggestion(name, [*CASES, BIPED])}")
    return table_one_problem(CASES[name]), table_one_changes(CASES[name], transcription)


def _built_and_solved(planner: VertexZmpPlanner, problem: PlanningProblem) -> tuple[float, PlanningOutcome]:
    built = planner.build(problem)
    return built.build_ms, planner.solve(built)
