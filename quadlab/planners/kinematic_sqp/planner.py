"""The kinematic planner of Gehring 2017 with an SQP of its own."""

import time
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import vstack

from quadlab.configuration import register
from quadlab.gaits.schedule import ContactSchedule
from quadlab.planners.checker import CheckerConfig, check_plan
from quadlab.planners.kinematic_sqp.config import KinematicSqpConfig
from quadlab.planners.kinematic_sqp.program import KinematicProgram
from quadlab.planners.kinematic_sqp.solution import motion_plan
from quadlab.planners.kinematic_sqp.sqp import Minimum, minimise
from quadlab.planners.kinematic_sqp.step_problem import inequality_rows
from quadlab.planners.kinematic_sqp.switches import beside_samples
from quadlab.planners.kinematic_sqp.transcription import transcribe
from quadlab.planners.plan import PlanReport
from quadlab.planners.planner import PlanningOutcome, PlanningStatus
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.validation import validate_problem

_INFEASIBLE = 2  # status of SciPy's linprog
_FEWEST_OF_POLYGON = 3


@dataclass(frozen=True)
class KinematicSqpBuild:
    """A problem and its program.

    Attributes:
        problem: in words.
        program: in letters.
        build_ms: wall time of the transcription in [ms].
    """

    problem: PlanningProblem
    program: KinematicProgram
    build_ms: float


@register("planner", "kinematic_sqp")
class KinematicSqpPlanner:
    """Base, joints, CoM, feet and loads of every sample at once, for a given contact schedule.

    Attributes:
        config: settings.
    """

    Config = KinematicSqpConfig

    def __init__(self, config: KinematicSqpConfig) -> None:
        self.config = config

    def prepare(self) -> None:
        """Do nothing: all it needs was loaded with this module."""

    def build(self, problem: PlanningProblem) -> KinematicSqpBuild:
        """Return the program of ``problem``.

        Raises:
            PlanningProblemError: if the problem is malformed or lacks the robot or its state.
        """
        validate_problem(problem)
        begin = time.perf_counter()
        program = transcribe(problem, self.config)
        program.prepare()
        return KinematicSqpBuild(problem, program, 1e3 * (time.perf_counter() - begin))

    def solve(self, transcription: KinematicSqpBuild) -> PlanningOutcome:
        """Solve, compare residuals with their tolerance, check the plan independently, return the outcome."""
        problem, program, config = transcription.problem, transcription.program, self.config
        contradiction = _contradiction(program, config.constraint_tolerance)
        if contradiction:
            return PlanningOutcome(PlanningStatus.INFEASIBLE, contradiction, None)
        minimum = minimise(program, config.sqp)
        if not minimum.converged:
            reason = _failure(program, minimum, config.constraint_tolerance)
            return PlanningOutcome(PlanningStatus.SOLVER_LIMIT, reason, None)
        residuals = program.violations(minimum.p)
        violated = _above(residuals, dict.fromkeys(residuals, config.constraint_tolerance))
        misses = program.consistency(minimum.p)
        violated = violated or _above(misses, dict.fromkeys(misses, config.consistency_mm))
        if violated:
            return PlanningOutcome(PlanningStatus.REJECTED, f"{minimum.reason}, but {violated}", None)
        plan = motion_plan(problem, program, minimum.p, _report(transcription, minimum, residuals | misses))
        verdict = check_plan(plan, problem, _checker(config, problem.schedule))
        if not verdict.accepted:
            found = f"the checker found {_above(verdict.values, verdict.tolerances)}"
            times_s, samples = program.grid.unrolled_times_s, config.samples_per_cycle
            beside = beside_samples(problem.schedule, problem.waypoints, times_s, samples)
            return PlanningOutcome(PlanningStatus.REJECTED, "; ".join(filter(None, (found, beside))), None)
        return PlanningOutcome(PlanningStatus.SOLVED, minimum.reason, replace(plan, verdict=verdict))


def _checker(config: KinematicSqpConfig, schedule: ContactSchedule) -> CheckerConfig:
    """Return the tolerances; those of the CoP are narrower where the support never is a mere segment."""
    if int(schedule.contacts.sum(axis=1).min()) < _FEWEST_OF_POLYGON:
        return config.checker
    return config.checker.model_copy(update={"cop_outside_mm": config.cop_outside_polygon_mm})


def _above(values: dict[str, float], tolerances: dict[str, float]) -> str:
    """Return a list of the values that are not within their tolerances, worst share first; empty if all are."""
    names = [name for name, value in values.items() if not value <= tolerances[name]]
    names.sort(key=lambda name: values[name] / max(tolerances[name], np.finfo(float).tiny), reverse=True)
    return ", ".join(f"{name} {values[name]:.3g} > {tolerances[name]:.3g}" for name in names)


def _failure(program: KinematicProgram, minimum: Minimum, tolerance: float) -> str:
    """Return where the iteration stopped and which constraint sets it left violated."""
    violations = program.violations(minimum.p)
    sets = _above(violations, dict.fromkeys(violations, tolerance)) or "none"
    return f"{minimum.reason}; constraint sets violated: {sets}"


def _contradiction(program: KinematicProgram, tolerance: float) -> str:
    """Return why no motion satisfies the constraints, or nothing if there is one.

    All constraints are linear: either the first guess satisfies them, or a linear program decides.
    """
    guess = program.elimination.expand(program.elimination.restrict(program.guess))
    violations = program.violations(guess)
    missed = _above(violations, dict.fromkeys(violations, tolerance))
    if not missed:
        return ""
    rows = inequality_rows(program.inequalities, program.elimination)
    result = linprog(
        np.zeros(rows.matrix.shape[1]),
        A_ub=vstack([rows.matrix, -rows.matrix], format="csr"),
        b_ub=np.concatenate([rows.upper, -rows.lower]),
        bounds=(None, None),
    )
    return f"no motion satisfies the constraints; at the start pose {missed}" if result.status == _INFEASIBLE else ""


def _report(build: KinematicSqpBuild, minimum: Minimum, residuals: dict[str, float]) -> PlanReport:
    program = build.program
    equalities = sum(len(equality.targets) for equality in program.equalities)
    inequalities = sum(len(inequality.lower) for inequality in program.inequalities)
    return PlanReport(
        planner="kinematic_sqp",
        build_ms=build.build_ms,
        solve_ms=minimum.solve_ms,
        iterations=len(minimum.steps),
        variables=program.layout.size,
        constraints=equalities + inequalities,
        costs=minimum.history[-1],
        residuals=residuals,
        cost_history=list(minimum.history),
    )
