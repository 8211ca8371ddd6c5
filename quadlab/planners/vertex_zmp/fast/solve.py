"""From a bilinear program to an answer: attempts one after the other, and a local least violation on the way."""

import time
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.config import VertexZmpConfig
from quadlab.planners.vertex_zmp.fast.program import BilinearProgram
from quadlab.planners.vertex_zmp.fast.solver.interior_point import CONVERGED, Answer, minimise
from quadlab.planners.vertex_zmp.fast.solver.kkt import KktPlan, kkt_plan, pair_products
from quadlab.planners.vertex_zmp.fast.solver.numbers import ProgramArrays, program_arrays
from quadlab.planners.vertex_zmp.fast.solver.state import Settings
from quadlab.planners.vertex_zmp.solution import Solution

_ATTEMPT_LIMIT = 60  # iterations of one attempt
_ELASTIC = 1e-3  # compliance of the constraints when their least violation is looked for
_DUAL_SHARE = 1000.0  # gradient tolerance over constraint tolerance


@dataclass(frozen=True)
class PreparedProgram:
    """A program with the plan of its factorisation.

    Attributes:
        program: the program.
        arrays: the same for the compiled solver.
        plan: plan for its pattern.
        pairs: products of the pairs of entries of the rows of G.
    """

    program: BilinearProgram
    arrays: ProgramArrays
    plan: KktPlan
    pairs: Array


def prepare(program: BilinearProgram) -> PreparedProgram:
    """Return ``program`` ready to be solved."""
    return PreparedProgram(program, program_arrays(program), kkt_plan(program), pair_products(program.inequality))


def solve(prepared: PreparedProgram, guess: Array, config: VertexZmpConfig) -> Solution:
    """Solve from ``guess``; if that fails look for a local least violation of all constraints and go on from there.

    If even that is more than the tolerance, the program counts as infeasible. This is no proof: the constraints are
    bilinear, and elsewhere they may have a solution.
    """
    begin = time.perf_counter()
    program, spent, first = prepared.program, 0, guess
    iterates: list[Array] = []
    word, infeasible, answer = "limit of iterations", False, None
    for attempt, (name, settings) in enumerate(_attempts(program, config)):
        left = min(settings.max_iterations, config.max_iterations - spent)
        arrays = prepared.arrays if settings.elastic == 0.0 else _without_costs(prepared.arrays)
        answer = minimise(arrays, prepared.plan, prepared.pairs, first, settings._replace(max_iterations=left))
        spent += answer.iterations
        iterates.append(answer.iterates)
        if settings.elastic > 0.0:
            infeasible = _is_infeasible(program, answer, config.residual_tolerance)
            first = answer.z if np.isfinite(answer.z).all() else guess
        elif answer.end == CONVERGED:
            word = "converged" if attempt == 0 else f"converged in attempt {attempt + 1} ({name})"
            return _solution(program, answer, iterates, spent, word, True, False, begin)
        if infeasible or spent >= config.max_iterations:
            break
    if infeasible:
        word = "local least violation of the constraints is above the tolerance"
    return _solution(program, answer, iterates, spent, word, False, infeasible, begin)


def _attempts(program: BilinearProgram, config: VertexZmpConfig) -> Iterator[tuple[str, Settings]]:
    """Yield settings from fast to careful; after the first a local least violation is looked for."""
    indifferent = not program.cost_rows
    usual = Settings(
        max_iterations=_ATTEMPT_LIMIT,
        tolerance=config.solver_tolerance,
        dual_tolerance=_DUAL_SHARE * config.solver_tolerance,
        barrier=1e-2 if indifferent else 1e-3,
        proximal=1e-3 if indifferent else 3e-4,
        polish=1.0,
        curvature=True,
        elastic=0.0,
        feasible_is_enough=indifferent,
        largest_growth=0.1,
    )
    careful = usual._replace(curvature=False, barrier=0.1, proximal=1e-2, max_iterations=3 * _ATTEMPT_LIMIT)
    elastic = careful._replace(
        elastic=_ELASTIC, proximal=1e-3, feasible_is_enough=False, max_iterations=2 * _ATTEMPT_LIMIT
    )
    yield "usual", usual
    yield "elastic", elastic
    yield "from the least violation", usual
    yield "careful", careful


def _without_costs(arrays: ProgramArrays) -> ProgramArrays:
    return arrays._replace(h_values=np.zeros_like(arrays.h_values), gradient=np.zeros_like(arrays.gradient))


def _is_infeasible(program: BilinearProgram, answer: Answer, tolerance: float) -> bool:
    return answer.end == CONVERGED and max(program.residuals(answer.z).values()) > tolerance


def _solution(
    program: BilinearProgram,
    answer: Answer | None,
    iterates: list[Array],
    iterations: int,
    word: str,
    converged: bool,
    infeasible: bool,
    begin: float,
) -> Solution:
    z = np.full(program.size, np.nan) if answer is None else answer.z
    elapsed = 1e3 * (time.perf_counter() - begin)
    return Solution(
        x=z,
        status=f"interior point: {word}",
        converged=converged,
        infeasible=infeasible,
        iterations=iterations,
        solve_ms=elapsed,
        costs=program.costs(z),
        residuals=program.residuals(z),
        cost_history=tuple(program.costs(iterate) for attempt in iterates for iterate in attempt),
    )
