"""Ipopt on a transcription, and what is true of its answer whatever its status says."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.config import VertexZmpConfig
from quadlab.planners.vertex_zmp.paper.iterates import IterateRecorder
from quadlab.planners.vertex_zmp.paper.transcription import Transcription
from quadlab.planners.vertex_zmp.solution import Solution, worst_violation

_CONVERGED = ("Solve_Succeeded", "Solved_To_Acceptable_Level")
_CLOCK = "Maximum_WallTime_Exceeded"


@dataclass(frozen=True)
class IpoptSolver:
    """Ipopt for one program.

    Attributes:
        function: ``casadi.nlpsol``.
        recorder: what it told of its last solve.
    """

    function: Any
    recorder: IterateRecorder


def make_solver(transcription: Transcription, config: VertexZmpConfig) -> IpoptSolver:
    """Return Ipopt for this program: exact Hessian by automatic differentiation, MUMPS, silent."""
    sizes = (transcription.x.numel(), transcription.g.numel(), transcription.p.numel())
    recorder = IterateRecorder(*sizes)
    options: dict[str, Any] = {
        "print_time": False,
        "calc_lam_p": False,
        "no_nlp_grad": True,
        "error_on_fail": False,
        "iteration_callback": recorder,
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
    return IpoptSolver(ca.nlpsol("vertex_zmp", "ipopt", program, options), recorder)


def run_solver(solver: IpoptSolver, transcription: Transcription) -> Solution:
    """Solve from the first iterate of the transcription."""
    lower, upper = transcription.bounds_g
    solver.recorder.iterates.clear()
    begin = time.perf_counter()
    answer = solver.function(
        x0=transcription.guess, p=transcription.parameters, lbx=transcription.lower_x, lbg=lower, ubg=upper
    )
    solve_ms = 1e3 * (time.perf_counter() - begin)
    x = np.asarray(answer["x"]).ravel()
    stats = solver.function.stats()
    status = str(stats["return_status"])
    return Solution(
        x=x,
        status=f"Ipopt: {status}" + (" (the clock ended it, max_wall_time_s)" if status == _CLOCK else ""),
        converged=status in _CONVERGED,
        infeasible=status == "Infeasible_Problem_Detected",
        iterations=int(stats["iter_count"]),
        solve_ms=solve_ms,
        costs=evaluate_costs(transcription, [x])[0],
        residuals=_residuals(transcription, x, np.asarray(answer["g"]).ravel()),
        cost_history=tuple(evaluate_costs(transcription, solver.recorder.iterates)),
    )


def evaluate_costs(transcription: Transcription, iterates: Sequence[Array]) -> list[dict[str, float]]:
    """Return each weighted cost by name at every iterate, (n,) each."""
    names = [cost.name for cost in transcription.costs]
    expressions = [cost.weight * cost.expression for cost in transcription.costs]
    function = ca.Function("costs", [transcription.x, transcription.p], expressions)
    return [
        {name: float(value) for name, value in zip(names, _values(function, x, transcription), strict=True)}
        for x in iterates
    ]


def _values(function: Any, x: Array, transcription: Transcription) -> Sequence[Any]:
    """Return the outputs as a sequence; CasADi gives a single output bare."""
    values = function(x, transcription.parameters)
    return values if isinstance(values, tuple | list) else (values,)


def _residuals(transcription: Transcription, x: Array, g: Array) -> dict[str, float]:
    """Return the worst violation of each constraint set and of the bounds on loads."""
    residuals: dict[str, float] = {}
    begin = 0
    for constraint in transcription.constraints:
        values = g[begin : begin + len(constraint.lower)]
        residuals[constraint.name] = worst_violation(np.maximum(constraint.lower - values, values - constraint.upper))
        begin += len(values)
    residuals["load_unilateral"] = worst_violation(transcription.lower_x - x)
    return residuals
