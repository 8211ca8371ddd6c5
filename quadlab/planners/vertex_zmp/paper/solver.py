"""Ipopt on a transcription, and what is true of its answer whatever its status says."""

import time
from typing import Any

import casadi as ca
import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.config import VertexZmpConfig
from quadlab.planners.vertex_zmp.paper.transcription import Transcription
from quadlab.planners.vertex_zmp.solution import Solution

_CONVERGED = ("Solve_Succeeded", "Solved_To_Acceptable_Level")


def make_solver(transcription: Transcription, config: VertexZmpConfig) -> Any:
    """Return Ipopt for this program: exact Hessian by automatic differentiation, MUMPS, silent."""
    options: dict[str, Any] = {
        "print_time": False,
        "calc_lam_p": False,
        "no_nlp_grad": True,
        "error_on_fail": False,
        "ipopt": {
            "print_level": 0,
            "sb": "yes",
            "linear_solver": "mumps",
            "hessian_approximation": "exact",
            "max_iter": config.max_iterations,
            "max_wall_time": config.max_wall_time_s,
            "tol": config.solver_tolerance,
        },
    }
    program = {"x": transcription.x, "p": transcription.p, "f": transcription.f, "g": transcription.g}
    return ca.nlpsol("vertex_zmp", "ipopt", program, options)


def run_solver(solver: Any, transcription: Transcription) -> Solution:
    """Solve from the first iterate of the transcription."""
    lower, upper = transcription.bounds_g
    begin = time.perf_counter()
    answer = solver(x0=transcription.guess, p=transcription.parameters, lbx=transcription.lower_x, lbg=lower, ubg=upper)
    solve_ms = 1e3 * (time.perf_counter() - begin)
    x = np.asarray(answer["x"]).ravel()
    stats = solver.stats()
    status = str(stats["return_status"])
    return Solution(
        x=x,
        status=f"Ipopt: {status}",
        converged=status in _CONVERGED,
        infeasible=status == "Infeasible_Problem_Detected",
        iterations=int(stats["iter_count"]),
        solve_ms=solve_ms,
        costs=evaluate_costs(transcription, x),
        residuals=_residuals(transcription, x, np.asarray(answer["g"]).ravel()),
    )


def evaluate_costs(transcription: Transcription, x: Array) -> dict[str, float]:
    """Return each weighted cost at ``x``."""
    expressions = [cost.weight * cost.expression for cost in transcription.costs]
    values = ca.Function("costs", [transcription.x, transcription.p], expressions)(x, transcription.parameters)
    return {cost.name: float(value) for cost, value in zip(transcription.costs, values, strict=True)}


def _residuals(transcription: Transcription, x: Array, g: Array) -> dict[str, float]:
    """Return the worst violation of each constraint set and of the bounds on loads."""
    residuals: dict[str, float] = {}
    begin = 0
    for constraint in transcription.constraints:
        values = g[begin : begin + len(constraint.lower)]
        residuals[constraint.name] = _worst(np.maximum(constraint.lower - values, values - constraint.upper))
        begin += len(values)
    residuals["load_unilateral"] = _worst(transcription.lower_x - x)
    return residuals


def _worst(violations: Array) -> float:
    """Return the largest violation, at least 0; NaN if there is one."""
    return float(np.maximum(violations, 0.0).max(initial=0.0))
