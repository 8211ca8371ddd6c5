"""Sequential quadratic programming with a Gauss-Newton Hessian and a line search on the objective."""

import time
from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.config import SqpConfig
from quadlab.planners.kinematic_sqp.program import KinematicProgram
from quadlab.planners.kinematic_sqp.qp.solvers import QP_SOLVERS
from quadlab.planners.kinematic_sqp.step_problem import find_step, inequality_rows


@dataclass(frozen=True)
class Iterate:
    """One point of the iteration.

    Attributes:
        y: free variables.
        costs: alpha_j f_j by name.
    """

    y: Array
    costs: dict[str, float]

    @property
    def objective(self) -> float:
        """Sum of all costs."""
        return sum(self.costs.values())


@dataclass(frozen=True)
class Minimum:
    """Where the iteration ended.

    Attributes:
        p: all variables, (size of p,).
        history: costs by name of the guess and after every iteration.
        steps: length of every step as a share of the full one.
        converged: whether the objective stopped changing.
        reason: one line.
        qp_failed: whether it ended because a quadratic program was not solved.
        solve_ms: wall time in [ms].
    """

    p: Array
    history: tuple[dict[str, float], ...]
    steps: tuple[float, ...]
    converged: bool
    reason: str
    qp_failed: bool
    solve_ms: float


def minimise(program: KinematicProgram, config: SqpConfig) -> Minimum:
    """Minimise the objective from the program's guess.

    All constraints are linear, so an iterate that satisfies them keeps doing so after any step in (0, 1]; the merit
    function is the objective itself (Armijo, halving).
    """
    begin = time.perf_counter()
    solver = QP_SOLVERS[config.qp_solver]()
    rows = inequality_rows(program.inequalities, program.elimination)
    iterates, steps = [_iterate(program, program.elimination.restrict(program.guess))], []
    converged, failed, reason = False, False, f"no convergence in {config.max_iterations} iterations"
    while len(steps) < config.max_iterations and not converged:
        current = iterates[-1]
        model = program.linearise(current.y)
        step = find_step(model, rows, current.y, solver, config.qp_tolerance)
        if not step.residual <= config.qp_residual:
            failed = True
            reason = f"quadratic program {len(steps) + 1}: residual {step.residual:.2g} > {config.qp_residual:g}"
            break
        slope = float(model.gradient @ step.step)
        share, following = _line_search(program, current, step.step, slope, config)
        iterates.append(following)
        steps.append(share)
        predicted = -slope - 0.5 * float(step.step @ (model.hessian @ step.step))
        change = max(predicted, abs(current.objective - following.objective))
        converged = change <= config.convergence * max(1.0, following.objective)
    if converged:
        reason = f"converged in {len(steps)} iterations"
    return Minimum(
        p=program.elimination.expand(iterates[-1].y),
        history=tuple(iterate.costs for iterate in iterates),
        steps=tuple(steps),
        converged=converged,
        reason=reason,
        qp_failed=failed,
        solve_ms=1e3 * (time.perf_counter() - begin),
    )


def _iterate(program: KinematicProgram, y: Array) -> Iterate:
    return Iterate(y, program.costs(program.elimination.expand(y)))


def _line_search(
    program: KinematicProgram, current: Iterate, step: Array, slope: float, config: SqpConfig
) -> tuple[float, Iterate]:
    """Return the first of the shares 1, 1/2, ... that decreases the objective enough, or the smallest, and where it leads.

    A step that leads from outside into the constraints may have to increase the objective; it is taken whole.
    """
    share = 1.0
    while True:
        following = _iterate(program, current.y + share * step)
        enough = current.objective + config.armijo * share * slope
        if slope >= 0.0 or following.objective <= enough or share <= config.smallest_step:
            return share, following
        share *= 0.5


def objective_history(minimum: Minimum) -> Array:
    """Return the objective of the guess and after every iteration, (iterations + 1,)."""
    return np.array([sum(costs.values()) for costs in minimum.history])
