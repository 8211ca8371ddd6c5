"""The vertex-ZMP planner of Winkler 2017 for point feet, with CasADi and Ipopt."""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from quadlab.configuration import register
from quadlab.planners.checker import check_plan
from quadlab.planners.plan import PlanReport
from quadlab.planners.planner import PlanningOutcome, PlanningStatus
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.validation import farthest_travel, validate_problem
from quadlab.planners.vertex_zmp.config import VertexZmpConfig
from quadlab.planners.vertex_zmp.solution import motion_plan, with_verdict
from quadlab.planners.vertex_zmp.solver import Solution, make_solver, run_solver
from quadlab.planners.vertex_zmp.transcription import Transcription, transcribe


@dataclass(frozen=True)
class VertexZmpBuild:
    """A transcription with the solver that was made for it.

    Attributes:
        transcription: the nonlinear program.
        solver: Ipopt, ready to run.
        build_ms: wall time of both in [ms].
    """

    transcription: Transcription
    solver: Any
    build_ms: float


@register("planner", "vertex_zmp")
class VertexZmpPlanner:
    """CoM motion, footholds and load shares at once, for a given contact schedule.

    Attributes:
        config: settings.
    """

    Config = VertexZmpConfig

    def __init__(self, config: VertexZmpConfig) -> None:
        self.config = config

    def build(self, problem: PlanningProblem) -> VertexZmpBuild:
        """Return the nonlinear program of ``problem`` and its solver.

        Raises:
            PlanningProblemError: if the problem is malformed.
        """
        validate_problem(problem)
        begin = time.perf_counter()
        transcription = transcribe(problem, self.config)
        solver = make_solver(transcription, self.config)
        return VertexZmpBuild(transcription, solver, 1e3 * (time.perf_counter() - begin))

    def solve(self, transcription: VertexZmpBuild) -> PlanningOutcome:
        """Solve, compare residuals with their tolerance, check the plan independently, return the outcome."""
        problem = transcription.transcription.problem
        too_far = _out_of_range(problem)
        if too_far:
            return PlanningOutcome(PlanningStatus.INFEASIBLE, too_far, None)
        solution = run_solver(transcription.solver, transcription.transcription)
        violated = {k: v for k, v in solution.residuals.items() if not v <= self.config.residual_tolerance}
        if violated or not solution.converged:
            status = PlanningStatus.INFEASIBLE if solution.infeasible else PlanningStatus.SOLVER_LIMIT
            return PlanningOutcome(status, _failure(solution, violated, self.config.residual_tolerance), None)
        plan = motion_plan(transcription.transcription, solution.x, _report(transcription, solution))
        verdict = check_plan(plan, problem, self.config.checker)
        if not verdict.accepted:
            found = ", ".join(f"{n} {verdict.values[n]:.3g} > {verdict.tolerances[n]:.3g}" for n in verdict.violated)
            return PlanningOutcome(PlanningStatus.REJECTED, f"the checker found {found}", None)
        return PlanningOutcome(PlanningStatus.SOLVED, f"Ipopt: {solution.status}", with_verdict(plan, verdict))


def _out_of_range(problem: PlanningProblem) -> str | None:
    """Return why no motion with this schedule reaches the goal, or None if distance alone does not exclude it."""
    poses = problem.waypoints.poses
    distance = float(np.linalg.norm(poses[-1, :2] - problem.start.com_position))
    farthest = farthest_travel(problem.schedule, problem.model, float(np.abs(np.diff(poses[:, 2])).sum()))
    if distance <= farthest:
        return None
    return (
        f"goal_state: {distance:.3g} m away; range_of_motion allows less than {farthest:.3g} m "
        f"in the {problem.schedule.duration_s:g} s of this schedule"
    )


def _failure(solution: Solution, violated: dict[str, float], tolerance: float) -> str:
    """Return where Ipopt stopped and which constraint sets it left violated, worst first."""
    worst = sorted(violated.items(), key=lambda item: item[1], reverse=True)
    sets = ", ".join(f"{name} {value:.2e}" for name, value in worst) or "none"
    return (
        f"Ipopt stopped after {solution.iterations} iterations with {solution.status}; "
        f"constraint sets violated by more than {tolerance:g}: {sets}"
    )


def _report(build: VertexZmpBuild, solution: Solution) -> PlanReport:
    return PlanReport(
        planner="vertex_zmp",
        build_ms=build.build_ms,
        solve_ms=solution.solve_ms,
        iterations=solution.iterations,
        variables=len(solution.x),
        constraints=sum(len(constraint.lower) for constraint in build.transcription.constraints),
        costs=solution.costs,
        residuals=solution.residuals,
    )
