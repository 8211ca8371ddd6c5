"""Solving the program through qpsolvers; the residuals decide, not the solver's status."""

import time
import warnings
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix

from quadlab.errors import MissingDependencyError
from quadlab.geometry.rotations import Array
from quadlab.planners.zmp_spline.program import QuadraticProgram

_DENSE = {"daqp"}
_SETTINGS = {
    "piqp": lambda eps: {"eps_abs": eps, "eps_rel": 0.0},
    "clarabel": lambda eps: {"tol_feas": eps, "tol_gap_abs": eps, "tol_gap_rel": eps},
    "daqp": lambda eps: {"primal_tol": eps, "dual_tol": eps},
}
"""How each solver is asked for an absolute tolerance."""


@dataclass(frozen=True)
class QpAnswer:
    """Where a solver stopped.

    Attributes:
        solution: z, (n,); zeros if there is no answer.
        residual: largest violation of the optimality conditions, infinite if there is no answer; dimensionless.
        iterations: of the solver; 0 if it does not tell (clarabel and daqp through qpsolvers).
        solve_ms: wall time in [ms].
    """

    solution: Array
    residual: float
    iterations: int
    solve_ms: float


def solve_program(program: QuadraticProgram, solver: str, tolerance: float) -> QpAnswer:
    """Return the answer of ``solver`` (its name in qpsolvers) with absolute ``tolerance``, whatever it says of it.

    Raises:
        MissingDependencyError: if the solver is not installed.
    """
    import qpsolvers  # noqa: PLC0415  loads every solver that is installed
    from qpsolvers.exceptions import SolverError  # noqa: PLC0415

    if solver not in qpsolvers.available_solvers:
        known = ", ".join(sorted(_SETTINGS.keys() & set(qpsolvers.available_solvers))) or "none"
        raise MissingDependencyError(f"planner.qp_solver: '{solver}' is not installed; installed: {known}")
    matrices = csc_matrix(program.hessian), csc_matrix(program.rows)
    hessian, rows = (matrix.toarray() for matrix in matrices) if solver in _DENSE else matrices
    problem = qpsolvers.Problem(hessian, program.gradient, rows, program.upper)
    began = time.perf_counter()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of solvers that give up; the residual says so
            found = qpsolvers.solve_problem(problem, solver=solver, **_SETTINGS[solver](tolerance))
    except SolverError:  # raised by some wrappers for what others report as a status
        found = qpsolvers.Solution(problem)
    solve_ms = 1e3 * (time.perf_counter() - began)
    iterations = int(getattr(found.extras.get("info"), "iter", 0))
    if found.x is None or found.z is None:
        return QpAnswer(np.zeros(len(program.gradient)), np.inf, iterations, solve_ms)
    solution = np.asarray(found.x, float)
    return QpAnswer(solution, optimality_residual(program, solution, found.z), iterations, solve_ms)


def optimality_residual(program: QuadraticProgram, solution: Array, multipliers: Array) -> float:
    """Return the largest violation of the Karush-Kuhn-Tucker conditions, apart from the bounds themselves.

    H z + g + G^T y = 0, y >= 0, y (G z - h) = 0, relative to the largest entry of the gradient (at least 1); infinite
    if a number is not finite.

    Args:
        program: H, g, G, h.
        solution: z, (n,).
        multipliers: y, (m,).
    """
    if not (np.isfinite(solution).all() and np.isfinite(multipliers).all()):
        return float("inf")
    scale = max(1.0, float(np.abs(program.gradient).max(initial=0.0)))
    stationarity = program.hessian @ solution + program.gradient + program.rows.T @ multipliers
    gaps = multipliers * (program.rows @ solution - program.upper)
    worst = (np.abs(stationarity).max(initial=0.0), np.abs(gaps).max(initial=0.0), (-multipliers).max(initial=0.0))
    return float(max(worst)) / scale
