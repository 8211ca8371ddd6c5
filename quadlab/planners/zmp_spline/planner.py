"""The ZMP walk planner of Bellicoso 2016, VI-B, after Kalakrishnan 2010 and Winkler 2015."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from quadlab.configuration import register
from quadlab.planners.checker import check_plan
from quadlab.planners.plan import PlanReport
from quadlab.planners.planner import PlanningOutcome, PlanningStatus
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.validation import validate_problem
from quadlab.planners.zmp_spline.config import ZmpSplineConfig
from quadlab.planners.zmp_spline.constraints.zmp_in_support import NAME as SUPPORT
from quadlab.planners.zmp_spline.program import QuadraticProgram, elastic
from quadlab.planners.zmp_spline.qp import QpAnswer, solve_program
from quadlab.planners.zmp_spline.transcription import SplineTranscription, motion_plan, transcribe
from quadlab.robots.legs import foot_names


@register("planner", "zmp_spline")
class ZmpSplinePlanner:
    """CoM motion of least acceleration whose ZMP stays in given supports: one convex program, for walks.

    Footholds are fixed beforehand. A support without area (trot, pace, bound) has no room for a margin: such
    schedules are INFEASIBLE unless ``support_slack_weight`` is set.

    Attributes:
        config: settings.
    """

    Config = ZmpSplineConfig

    def __init__(self, config: ZmpSplineConfig) -> None:
        self.config = config

    def prepare(self) -> None:
        """Do nothing: all it needs was loaded with this module."""

    def build(self, problem: PlanningProblem) -> SplineTranscription:
        """Return the program of ``problem``, ready to be solved.

        Raises:
            PlanningProblemError: if the problem is malformed.
        """
        validate_problem(problem)
        return transcribe(problem, self.config)

    def solve(self, transcription: SplineTranscription) -> PlanningOutcome:
        """Solve, compare residuals with their tolerances, check the plan independently, return the outcome."""
        program = transcription.program
        if program is None:
            return PlanningOutcome(PlanningStatus.INFEASIBLE, _empty_support(transcription), None)
        answer = solve_program(program, self.config.qp_solver, self.config.qp_tolerance)
        states = program.states(answer.solution)
        violated = self._violated(program, states)
        if violated or not answer.residual <= self.config.optimality_tolerance:
            return self._failed(transcription, program, answer, violated)
        plan = motion_plan(transcription.model, states, self._report(transcription, program, answer))
        verdict = check_plan(plan, transcription.problem, self.config.checker)
        if not verdict.accepted:
            return PlanningOutcome(PlanningStatus.REJECTED, f"the checker found {verdict.complaint}", None)
        said = f"{self.config.qp_solver}: optimality residual {answer.residual:.1e}"
        return PlanningOutcome(PlanningStatus.SOLVED, said, replace(plan, verdict=verdict))

    def _violated(self, program: QuadraticProgram, states: np.ndarray) -> dict[str, float]:
        """Return the sets of hard bounds that ``states`` violate by more than the tolerance, in [m]."""
        found = program.violations(states)
        hard = [bound.name for bound in program.bounds if bound.slack_weights is None]
        return {name: found[name] for name in hard if not found[name] <= self.config.constraint_tolerance_m}

    def _failed(
        self,
        transcription: SplineTranscription,
        program: QuadraticProgram,
        answer: QpAnswer,
        violated: Mapping[str, float],
    ) -> PlanningOutcome:
        """Return what the constraints contradict in, or that the solver did not get as far as it should.

        The program is convex: what its closest motion, found to within the tolerance, violates by more than the
        elasticity of the bounds, every motion violates.
        """
        relaxed = elastic(transcription.model.grid, transcription.problem, program)
        freed = solve_program(relaxed, self.config.qp_solver, self.config.qp_tolerance)
        states = relaxed.states(freed.solution)
        left = {name: value for name, value in relaxed.violations(states).items() if value > _CONTRADICTION_M}
        if not left or not freed.residual <= self.config.optimality_tolerance:
            sets = ", ".join(f"{name} {value:.2e}" for name, value in violated.items()) or "none"
            reason = (
                f"{self.config.qp_solver} failed: optimality residual {answer.residual:.1e}, "
                f"{freed.residual:.1e} with elastic constraints; violated sets: {sets}"
            )
            return PlanningOutcome(PlanningStatus.SOLVER_LIMIT, reason, None)
        worst = sorted(left.items(), key=lambda item: item[1], reverse=True)
        sets = ", ".join(f"{n} {v:.3f} at {relaxed.worst_time_s(n, states):.2f} s" for n, v in worst)
        reason = f"the constraints contradict each other; the closest motion violates {sets}"
        return PlanningOutcome(PlanningStatus.INFEASIBLE, reason, None)

    def _report(self, build: SplineTranscription, program: QuadraticProgram, answer: QpAnswer) -> PlanReport:
        states = program.states(answer.solution)
        return PlanReport(
            planner="zmp_spline",
            build_ms=build.build_ms,
            solve_ms=answer.solve_ms,
            iterations=answer.iterations,
            variables=len(program.gradient),
            constraints=len(program.upper),
            costs=program.cost_values(states),
            residuals=program.violations(states) | {"optimality": answer.residual},
        )


_CONTRADICTION_M = 1e-4  # [m] less is the elasticity of the bounds, not a contradiction


def _empty_support(transcription: SplineTranscription) -> str:
    """Return which phase leaves the ZMP no room."""
    model = transcription.model
    phase = next(number for number, support in enumerate(model.supports) if support.is_empty)
    schedule = model.problem.schedule
    standing = schedule.contacts[phase]
    names = ", ".join(name for name, stands in zip(foot_names(len(standing)), standing, strict=True) if stands)
    start_s = float(schedule.switch_times_s[phase])
    return (
        f"{SUPPORT}: nothing of the support of {names} (phase {phase}, from {start_s:.2f} s) is left inside the margin "
        f"of {1e3 * model.margin:g} mm; this planner is for walks, whose supports have an area"
    )
