"""Sequential quadratic programming with a Gauss-Newton Hessian and a line search on the objective."""

import time
from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.config import SqpConfig
from quadlab.planners.kinematic_sqp.program import KinematicProgram, Linearisation
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
        solve_ms: wall time in [ms].
    """

    p: Array
    history: tuple[dict[str, float], ...]
    steps: tuple[float, ...]
    converged: bool
    reason: str
    solve_ms: float


def minimise(program: KinematicProgram, config: SqpConfig) -> Minimum:
    """Minimise the objective from the program's guess.

    All constraints are linear, so an iterate that satisfies them keeps doing so after any step in (0, 1]; the merit
    function is the objective itself (Armijo, halving).
    """
    begin = time.perf_counter()
    solver = QP_SOLVERS[config.qp_solver]()
    rows = inequality_rows(program.inequalities, program.elimination)
    iterates = [_iterate(program, program.elimination.restrict(program.guess))]
    steps: list[float] = []
    reason, change = "", np.inf
    while not reason:
        model = program.linearise(iterates[-1].y)
        step = find_step(model, rows, iterates[-1].y, solver, config.qp_tolerance)
        if not step.residual <= config.qp_residual:
            reason = f"quadratic program {len(steps) + 1}: residual {step.residual:.2g} > {config.qp_residual:g}"
            break
        share, following = _line_search(program, iterates[-1], step.step, model, config)
        change = _change(iterates[-1], following, step.step, model)
        iterates.append(following)
        steps.append(share)
        reason = _end(len(steps), change, time.perf_counter() - begin, config)
    return Minimum(
        p=program.elimination.expand(iterates[-1].y),
        history=tuple(iterate.costs for iterate in iterates),
        steps=tuple(steps),
        converged=change <= config.convergence,
        reason=reason,
        solve_ms=1e3 * (time.perf_counter() - begin),
    )


def _end(iterations: int, change: float, elapsed_s: float, config: SqpConfig) -> str:
    """Return why the iteration ends here, or nothing if it goes on."""
    if change <= config.convergence:
        return f"converged in {iterations} iterations"
    if iterations >= config.max_iterations:
        return f"no convergence in {iterations} iterations and {elapsed_s:.2f} s"
    if elapsed_s < config.max_wall_time_s:
        return ""
    limit = f"max_wall_time_s {config.max_wall_time_s:g}"
    return f"no convergence: the clock ended it after {iterations} iterations, {limit}"


def _change(current: Iterate, following: Iterate, step: Array, model: Linearisation) -> float:
    """Return the larger of predicted and real change of the objective, relative to the objective (at least 1)."""
    predicted = -float(model.gradient @ step) - 0.5 * float(step @ (model.hessian @ step))
    return max(abs(predicted), abs(current.objective - following.objective)) / max(1.0, following.objective)


def _iterate(program: KinematicProgram, y: Array) -> Iterate:
    return Iterate(y, program.costs(program.elimination.expand(y)))


def _line_search(
    program: KinematicProgram, current: Iterate, step: Array, model: Linearisation, config: SqpConfig
) -> tuple[float, Iterate]:
    """Return the first of the shares 1, 1/2, ... that decreases the objective enough, and where it leads.

    A step that leads from outside into the constraints may have to increase the objective; it is taken whole.
    """
    slope, share = float(model.gradient @ step), 1.0
    while True:
        following = _iterate(program, current.y + share * step)
        enough = current.objective + config.armijo * share * slope
        if slope >= 0.0 or following.objective <= enough or share <= config.smallest_step:
            return share, following
        share *= 0.5


def objective_history(minimum: Minimum) -> Array:
    """Return the objective of the guess and after every iteration, (iterations + 1,)."""
    return np.array([sum(costs.values()) for costs in minimum.history])
