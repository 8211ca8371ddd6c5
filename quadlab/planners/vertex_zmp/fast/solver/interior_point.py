"""A primal-dual interior-point method with Mehrotra's predictor and corrector for bilinear programs."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.jit import source_fingerprint
from quadlab.planners.vertex_zmp.fast.solver.direction import newton_step
from quadlab.planners.vertex_zmp.fast.solver.evaluation import evaluate, inequality_values
from quadlab.planners.vertex_zmp.fast.solver.jit import compiled, compiled_entry
from quadlab.planners.vertex_zmp.fast.solver.kkt import KktPlan
from quadlab.planners.vertex_zmp.fast.solver.matrix import Workspace, factorise_kkt
from quadlab.planners.vertex_zmp.fast.solver.numbers import ProgramArrays
from quadlab.planners.vertex_zmp.fast.solver.state import Iterate, Residuals, Settings
from quadlab.planners.vertex_zmp.fast.solver.step_length import (
    HUGE,
    advance,
    complementarity,
    complementarity_after,
    largest,
    restrained,
    shortened,
    step_lengths,
)

_TARGET_SHARE = 1e-3  # complementarity stays above this share of the violation
_NEARLY_FEASIBLE = 1e-4  # violation of the equalities below which they converge in one or two more steps
CONVERGED, STEP_LIMIT, NOT_FINITE = 0, 1, 2


class Answer(NamedTuple):
    """Where the method stopped.

    Attributes:
        z: last iterate.
        end: CONVERGED, STEP_LIMIT or NOT_FINITE.
        iterations, factorisations: how many there were.
        equality, dual, complementarity: largest residuals.
        iterates: the first guess and z after every iteration, (iterations + 1, n).
    """

    z: Array
    end: int
    iterations: int
    factorisations: int
    equality: float
    dual: float
    complementarity: float
    iterates: Array


@compiled
def _minimise(program: ProgramArrays, plan: KktPlan, pair_products: Array, first: Array, settings: Settings) -> Answer:
    at, step, found, work = _memory(program, plan, pair_products)
    at.z[:] = first
    iterates = np.empty((settings.max_iterations + 1, len(first)))
    _first_slacks(program, settings, at, found)
    end, factorisations, iteration = STEP_LIMIT, 0, 0
    violation = dual = gap = np.inf
    settled = False  # from then on unknowns are held in place: where costs leave them free, steps wander about
    for iteration in range(settings.max_iterations + 1):
        iterates[iteration] = at.z
        evaluate(program, at, settings.elastic, found)
        gap = complementarity(program, at)
        violation, dual = largest(found.equality), largest(found.dual)
        slack = max(largest(found.lower), largest(found.upper))
        if not violation + dual + gap < HUGE:  # false for NaN as well
            end = NOT_FINITE
            break
        settled = settled or _settled(settings, violation, dual, gap)
        if _finished(program, settings, found, violation, slack, settled or dual <= settings.dual_tolerance, gap):
            end = CONVERGED
            break
        if iteration == settings.max_iterations:
            break
        proximal = settings.polish if settled else settings.proximal
        factorisations += factorise_kkt(program, plan, at, found, proximal, settings, work)
        floor = min(max(_TARGET_SHARE * max(violation, slack), 0.1 * settings.tolerance), gap)
        target, primal, dual_length = 0.0, 1.0, 1.0
        for stage in range(2):  # predictor, corrector
            newton_step(program, plan, at, found, settings, target, stage == 1, work, step)
            primal, dual_length = step_lengths(program, at, step)
            if stage == 0 and gap > 0.0:
                share = complementarity_after(program, at, step, primal, dual_length) / gap
                target = max(share**3 * gap, floor)
        primal, dual_length = shortened(primal), shortened(dual_length)
        primal = restrained(program, step, found, violation, primal, settings.largest_growth)
        advance(program, at, step, primal, dual_length)
    return Answer(at.z, end, iteration, factorisations, violation, dual, gap, iterates[: iteration + 1])


@compiled
def _memory(
    program: ProgramArrays, plan: KktPlan, pair_products: Array
) -> tuple[Iterate, Iterate, Residuals, Workspace]:
    n, e, i = len(program.gradient), len(program.right), len(program.lower)
    elimination = plan.elimination
    at = Iterate(np.zeros(n), np.zeros(e), np.ones(i), np.zeros(i), np.ones(i), np.zeros(i))
    step = Iterate(np.zeros(n), np.zeros(e), np.zeros(i), np.zeros(i), np.zeros(i), np.zeros(i))
    found = Residuals(np.zeros(e), np.zeros(n), np.zeros(i), np.zeros(i), np.zeros(i), np.zeros(len(program.a_values)))
    work = Workspace(
        np.zeros(len(elimination.k_rows)),
        np.zeros(len(elimination.l_rows)),
        np.zeros(n + e),
        np.zeros(n + e),
        np.zeros(n + e, np.intp),
        np.zeros(n + e),
        np.zeros(i),
        np.zeros(i),
        pair_products,
    )
    return at, step, found, work


@compiled
def _first_slacks(program: ProgramArrays, settings: Settings, at: Iterate, found: Residuals) -> None:
    """Put slacks a tenth of the width of their interval inside, and multipliers at the first complementarity."""
    inequality_values(program, at.z, found.values)
    for row in range(len(found.values)):
        width = 1.0
        if program.has_lower[row] and program.has_upper[row]:
            width = max(program.upper[row] - program.lower[row], 1e-2)
        if program.has_lower[row]:
            at.t_lower[row] = max(found.values[row] - program.lower[row], 0.1 * width)
            at.w_lower[row] = settings.barrier / at.t_lower[row]
        if program.has_upper[row]:
            at.t_upper[row] = max(program.upper[row] - found.values[row], 0.1 * width)
            at.w_upper[row] = settings.barrier / at.t_upper[row]


@compiled
def _settled(settings: Settings, violation: float, dual: float, gap: float) -> bool:
    """Return whether only the equalities are left to converge."""
    return gap <= settings.tolerance and dual <= settings.dual_tolerance and violation <= _NEARLY_FEASIBLE


@compiled
def _finished(
    program: ProgramArrays,
    settings: Settings,
    found: Residuals,
    violation: float,
    slack: float,
    stationary: bool,
    gap: float,
) -> bool:
    """Return whether the iterate is optimal, or feasible if that is all that is asked for."""
    if not violation <= settings.tolerance:
        return False
    if settings.feasible_is_enough:
        for row in range(len(found.values)):
            if program.has_lower[row] and not found.values[row] >= program.lower[row]:
                return False
            if program.has_upper[row] and not found.values[row] <= program.upper[row]:
                return False
        return True
    return slack <= settings.tolerance and stationary and gap <= settings.tolerance


def _compile_entry(fingerprint: int) -> Callable[[ProgramArrays, KktPlan, Array, Array, Settings], Answer]:
    """Return the entry point, which is compiled anew when any file of this folder has changed."""

    def entry(program: ProgramArrays, plan: KktPlan, pair_products: Array, first: Array, settings: Settings) -> Answer:
        _ = fingerprint
        return _minimise(program, plan, pair_products, first, settings)

    return compiled_entry(entry)


_entry = _compile_entry(source_fingerprint(Path(__file__).parent))


def minimise(program: ProgramArrays, plan: KktPlan, pair_products: Array, first: Array, settings: Settings) -> Answer:
    """Solve ``program`` from the unknowns ``first``.

    Args:
        program: the program.
        plan: plan for its pattern.
        pair_products: products of the pairs of entries of the rows of its G.
        first: first iterate, (n,).
        settings: numbers that steer the method.
    """
    return _entry(program, plan, pair_products, first, settings)
