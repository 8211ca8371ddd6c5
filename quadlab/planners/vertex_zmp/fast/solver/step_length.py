"""How far a step may go, and what is left after it."""

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.solver.evaluation import largest_quadratic_change
from quadlab.planners.vertex_zmp.fast.solver.jit import compiled
from quadlab.planners.vertex_zmp.fast.solver.numbers import ProgramArrays
from quadlab.planners.vertex_zmp.fast.solver.state import Iterate, Residuals

HUGE = 1e100  # numbers beyond this count as not finite
_BACK_OFF = 0.995  # share of the way to the boundary
_SMALLEST_STEP = 0.05  # shorter steps are taken whatever they do to the equalities


@compiled
def largest(values: Array) -> float:
    """Return the largest magnitude; HUGE if there is one that is not finite."""
    found = 0.0
    for value in values:
        if not abs(value) < HUGE:  # false for NaN as well
            return HUGE
        found = max(found, float(abs(value)))
    return found


@compiled
def complementarity(program: ProgramArrays, at: Iterate) -> float:
    """Return the mean product of slack and multiplier."""
    return complementarity_after(program, at, at, 0.0, 0.0)


@compiled
def complementarity_after(program: ProgramArrays, at: Iterate, step: Iterate, primal: float, dual: float) -> float:
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
def step_lengths(program: ProgramArrays, at: Iterate, step: Iterate) -> tuple[float, float]:
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
def shortened(length: float) -> float:
    """Return a length that stays clear of the boundary; a whole step stays whole."""
    return _BACK_OFF * length if length < 1.0 else 1.0


@compiled
def restrained(
    program: ProgramArrays, step: Iterate, found: Residuals, violation: float, length: float, allowed: float
) -> float:
    """Return a length after which the equalities are not violated much more than before.

    For products of two unknowns this is exact: after a step of length a it is (1 - a) c + a^2 products(step).
    """
    if length <= _SMALLEST_STEP:
        return length
    error = largest_quadratic_change(program, step.z, found.equality)
    limit = max(2.0 * violation, allowed)
    while length > _SMALLEST_STEP and (1.0 - length) * violation + length**2 * error > limit:
        length *= 0.7
    return length


@compiled
def advance(program: ProgramArrays, at: Iterate, step: Iterate, primal: float, dual: float) -> None:
    """Add the step, with one length for unknowns and slacks and one for all multipliers, to ``at``."""
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
