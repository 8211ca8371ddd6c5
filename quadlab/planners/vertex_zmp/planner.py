"""The vertex-ZMP planner of Winkler 2017, with two transcriptions of the same problem."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from quadlab.configuration import register
from quadlab.planners.checker import check_plan
from quadlab.planners.plan import PlanReport
from quadlab.planners.planner import PlanningOutcome, PlanningStatus
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.validation import farthest_travel, validate_problem
from quadlab.planners.vertex_zmp.config import VertexZmpConfig
from quadlab.planners.vertex_zmp.solution import Build, Solution


@register("planner", "vertex_zmp")
class VertexZmpPlanner:
    """CoM motion, footholds and load shares at once, for a given contact schedule.

    Attributes:
        config: settings.
    """

    Config = VertexZmpConfig

    def __init__(self, config: VertexZmpConfig) -> None:
        self.config = config

    def prepare(self) -> None:
        """Load CasADi, or compile or load the machine code of ``fast``."""
        if self.config.transcription == "fast":
            from quadlab.planners.vertex_zmp.fast.warm_up import load_compiled  # noqa: PLC0415

            load_compiled(self.config)
        else:
            import quadlab.planners.vertex_zmp.paper.build  # noqa: F401, PLC0415

    def build(self, problem: PlanningProblem) -> Build:
        """Return the program of ``problem``, ready to be solved.

        Raises:
            PlanningProblemError: if the problem is malformed, or not one for the configured transcription.
        """
        validate_problem(problem)
        if self.config.transcription == "fast":  # each is imported on demand: CasADi and numba take long to load
            from quadlab.planners.vertex_zmp.fast.build import build_fast  # noqa: PLC0415

            return build_fast(problem, self.config)
        from quadlab.planners.vertex_zmp.paper.build import build_paper  # noqa: PLC0415

        return build_paper(problem, self.config)

    def solve(self, transcription: Build) -> PlanningOutcome:
        """Solve, compare residuals with their tolerance, check the plan independently, return the outcome."""
        problem = transcription.problem
        too_far = _out_of_range(problem)
        if too_far:
            return PlanningOutcome(PlanningStatus.INFEASIBLE, too_far, None)
        solution = transcription.solve()
        violated = {k: v for k, v in solution.residuals.items() if not v <= self.config.residual_tolerance}
        if violated or not solution.converged:
            status = PlanningStatus.INFEASIBLE if solution.infeasible else PlanningStatus.SOLVER_LIMIT
            return PlanningOutcome(status, _failure(solution, violated, self.config.residual_tolerance), None)
        plan = transcription.motion_plan(solution.x, _report(transcription, solution))
        verdict = check_plan(plan, problem, self.config.checker)
        if not verdict.accepted:
            return PlanningOutcome(PlanningStatus.REJECTED, f"the checker found {verdict.complaint}", None)
        return PlanningOutcome(PlanningStatus.SOLVED, solution.status, replace(plan, verdict=verdict))


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


def _failure(solution: Solution, violated: Mapping[str, float], tolerance: float) -> str:
    """Return where the solver stopped and which constraint sets it left violated, worst first."""
    worst = sorted(violated.items(), key=lambda item: item[1], reverse=True)
    sets = ", ".join(f"{name} {value:.2e}" for name, value in worst) or "none"
    return (
        f"{solution.status}, stopped after {solution.iterations} iterations; "
        f"constraint sets violated by more than {tolerance:g}: {sets}"
    )


def _report(build: Build, solution: Solution) -> PlanReport:
    variables, constraints = build.size
    return PlanReport(
        planner="vertex_zmp",
        build_ms=build.build_ms,
        solve_ms=solution.solve_ms,
        iterations=solution.iterations,
        variables=variables,
        constraints=constraints,
        costs=dict(solution.costs),
        residuals=dict(solution.residuals),
        cost_history=[dict(costs) for costs in solution.cost_history],
    )
