"""A primal-dual interior-point method with Mehrotra's predictor and corrector for bilinear programs."""

from typing import NamedTuple

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.solver.direction import Workspace, factorise_kkt, newton_step
from quadlab.planners.vertex_zmp.fast.solver.evaluation import (
    evaluate,
    inequality_values,
    largest_quadratic_change,
)
from quadlab.planners.vertex_zmp.fast.solver.jit import compiled, compiled_entry, source_fingerprint
from quadlab.planners.vertex_zmp.fast.solver.kkt import KktPlan
from quadlab.planners.vertex_zmp.fast.solver.numbers import ProgramArrays
from quadlab.planners.vertex_zmp.fast.solver.state import Iterate, Residuals, Settings

_FINGERPRINT = source_fingerprint()
_BACK_OFF = 0.995  # share of the way to the boundary
_SMALLEST_STEP = 0.05  # shorter steps are taken whatever they do to the equalities
_TARGET_SHARE = 1e-3  # complementarity stays above this share of the violation
_NEARLY_FEASIBLE = 1e-4  # violation of the equalities below which they converge in one or two more steps
CONVERGED, STEP_LIMIT, NOT_FINITE = 0, 1, 2


class Answer(NamedTuple):
    """Where the method stopped.

    Attributes:
        z: last iterate.
        end: _NEARLY_FEASIBLE = 1e-4  # violation of the equalities below which they converge in one or two more steps
CONVERGED, STEP_LIMIT or NOT_FINITE.
        iterations, factorisations: how many there were.
        equality, dual, complementarity: largest residuals.
    """

    z: Array
    end: int
    iterations: int
    factorisations: int
    equality: float
    dual: float
    complementarity: float


@compiled_entry
def minimise(program: ProgramArrays, plan: KktPlan, pair_products: Array, first: Array, settings: Settings) -> Answer:
    """Solve ``program`` from the unknowns ``first``.

    Args:
        program: the program.
        plan: plan for its pattern.
        pair_products: products of the pairs of entries of the rows of its G.
        first: first iterate, (n,).
        settings: numbers that steer the method.
    """
    _ = _FINGERPRINT
    at, step, found, work = _memory(program, plan, pair_products)
    at.z[:] = first
    _first_slacks(program, settings, at, found)
    end, factorisations, iteration = STEP_LIMIT, 0, 0
    violation = dual = gap = np.inf
    settled = False  # from then on unknowns are held in place: where costs leave them free, steps wander about
    for iteration in range(settings.max_iterations + 1):
        evaluate(program, at, first, settings, found)
        gap = _complementarity(program, at)
        violation, dual = _largest(found.equality), _largest(found.dual)
        slack = max(_largest(found.lower), _largest(found.upper))
        if not np.isfinite(violation + dual + gap):
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
        newton_step(program, plan, at, found, settings, 0.0, False, work, step)
        primal, dual_length = _lengths(program, at, step)
        centring = (_complementarity_after(program, at, step, primal, dual_length) / gap) ** 3 if gap > 0.0 else 0.0
        newton_step(program, plan, at, found, settings, max(centring * gap, floor), True, work, step)
        primal, dual_length = _lengths(program, at, step)
        primal, dual_length = _shortened(primal), _shortened(dual_length)
        primal = _restrained(program, step, found, violation, primal, settings.largest_growth)
        _advance(program, at, step, primal, dual_length)
    return Answer(at.z, end, iteration, factorisations, violation, dual, gap)


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
    small = gap <= settings.tolerance and dual <= settings.dual_tolerance and violation <= _NEARLY_FEASIBLE
    return small and not settings.centred


@compiled
def _largest(values: Array) -> float:
    """Return the largest magnitude; NaN if there is one."""
    largest = 0.0
    for value in values:
        if np.isnan(value):
            return np.nan
        largest = max(largest, abs(value))
    return largest


@compiled
def _complementarity(program: ProgramArrays, at: Iterate) -> float:
    """Return the mean product of slack and multiplier."""
    return _complementarity_after(program, at, at, 0.0, 0.0)


@compiled
def _complementarity_after(program: ProgramArrays, at: Iterate, step: Iterate, primal: float, dual: float) -> float:
    """Return the mean product of slack and multiplier after steps of the given lengths."""
    total, count = 0.0, 0
    for row in range(len(at.t_lower)):
        if program.has_lower[row]:
            total += (at.t_lower[row] + primal * step.t_lower[row]) * (at.w_lower[row] + dual * step.w_lower[row])
            count += 1
        if program.has_upper[row]:
            total += (at.t_upper[row] + primal * step.t_upper[row]) * (at.w_upper[row] + dual * step.w_upper[row])
            count += 1
    return total / max(count, 1)


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
    if violation > settings.tolerance:
        return False
    if settings.feasible_is_enough:
        for row in range(len(found.values)):
            if program.has_lower[row] and found.values[row] < program.lower[row]:
                return False
            if program.has_upper[row] and found.values[row] > program.upper[row]:
                return False
        return True
    return slack <= settings.tolerance and stationary and gap <= settings.tolerance


@compiled
def _lengths(program: ProgramArrays, at: Iterate, step: Iterate) -> tuple[float, float]:
    """Return how far slacks and multipliers can go before one of them is 0, at most 1."""
    primal, dual = 1.0, 1.0
    for row in range(len(at.t_lower)):
        if program.has_lower[row]:
            if step.t_lower[row] < 0.0 and -at.t_lower[row] > primal * step.t_lower[row]:
                primal = -at.t_lower[row] / step.t_lower[row]
            if step.w_lower[row] < 0.0 and -at.w_lower[row] > dual * step.w_lower[row]:
                dual = -at.w_lower[row] / step.w_lower[row]
        if program.has_upper[row]:
            if step.t_upper[row] < 0.0 and -at.t_upper[row] > primal * step.t_upper[row]:
                primal = -at.t_upper[row] / step.t_upper[row]
            if step.w_upper[row] < 0.0 and -at.w_upper[row] > dual * step.w_upper[row]:
                dual = -at.w_upper[row] / step.w_upper[row]
    return primal, dual


@compiled
def _shortened(length: float) -> float:
    return _BACK_OFF * length if length < 1.0 else 1.0


@compiled
def _restrained(
    program: ProgramArrays, step: Iterate, found: Residuals, violation: float, length: float, allowed: float
) -> float:
    """Return a length after which the equalities are not violated much more than before.

    For products of two unknowns this is exact: after a step of length a the violation is (1 - a) c + a^2 products(step).
    """
    if length <= _SMALLEST_STEP:
        return length
    error = largest_quadratic_change(program, step.z, found.equality)
    limit = max(2.0 * violation, allowed)
    while length > _SMALLEST_STEP and (1.0 - length) * violation + length**2 * error > limit:
        length *= 0.7
    return length


@compiled
def _advance(program: ProgramArrays, at: Iterate, step: Iterate, primal: float, dual: float) -> None:
    for column in range(len(at.z)):
        at.z[column] += primal * step.z[column]
    for row in range(len(at.y)):
        at.y[row] += dual * step.y[row]
    for row in range(len(at.t_lower)):
        if program.has_lower[row]:
            at.t_lower[row] += primal * step.t_lower[row]
            at.w_lower[row] += dual * step.w_lower[row]
        if program.has_upper[row]:
            at.t_upper[row] += primal * step.t_upper[row]
            at.w_upper[row] += dual * step.w_upper[row]
