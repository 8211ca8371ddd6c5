"""The Newton direction of the conditions of optimality."""

from typing import NamedTuple

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.solver.factor import factorise, solve_in_place
from quadlab.planners.vertex_zmp.fast.solver.jit import compiled
from quadlab.planners.vertex_zmp.fast.solver.kkt import KktPlan
from quadlab.planners.vertex_zmp.fast.solver.numbers import ProgramArrays
from quadlab.planners.vertex_zmp.fast.solver.state import Iterate, Residuals, Settings

_REGULARISATION = 1e-9  # keeps pivots of the equalities away from 0; a step solves them that much less exactly


class Workspace(NamedTuple):
    """Memory of the linear algebra.

    Attributes:
        k_values, l_values, inverse_pivots: the matrix and its factors.
        row, filled: work space of the factorisation.
        permuted: right-hand side in the order of elimination, (n + e,).
        e_lower, e_upper: what complementarity asks for, (i,).
        pair_products: products of the pairs of entries of each row of G.
    """

    k_values: Array
    l_values: Array
    inverse_pivots: Array
    row: Array
    filled: Array
    permuted: Array
    e_lower: Array
    e_upper: Array
    pair_products: Array


@compiled
def factorise_kkt(
    program: ProgramArrays,
    plan: KktPlan,
    at: Iterate,
    found: Residuals,
    proximal: float,
    settings: Settings,
    work: Workspace,
) -> int:
    """Factorise the matrix of the Newton step; return how often that took.

    The curvature of the products is left out where it would not leave exactly one negative pivot an equality.
    """
    count = len(at.y)
    if settings.curvature:
        _assemble(program, plan, at, found, proximal, settings.elastic, work.k_values, work.pair_products)
        for p in range(len(program.p_rows)):
            work.k_values[plan.from_products[p]] += program.p_coefficients[p] * at.y[program.p_rows[p]]
        negative = factorise(plan.elimination, work.k_values, work.l_values, work.inverse_pivots, work.row, work.filled)
        if negative == count:
            return 1
    _assemble(program, plan, at, found, proximal, settings.elastic, work.k_values, work.pair_products)
    factorise(plan.elimination, work.k_values, work.l_values, work.inverse_pivots, work.row, work.filled)
    return 2 if settings.curvature else 1


@compiled
def _assemble(
    program: ProgramArrays,
    plan: KktPlan,
    at: Iterate,
    found: Residuals,
    proximal: float,
    elastic: float,
    k_values: Array,
    pair_products: Array,
) -> None:
    """Write [H + proximal + G' D G, J'; J, -regularisation] to ``k_values``."""
    size = len(at.z)
    for entry in range(len(k_values)):
        k_values[entry] = 0.0
    for index in range(len(plan.diagonal)):
        k_values[plan.diagonal[index]] = proximal if index < size else -(elastic + _REGULARISATION)
    for entry in range(len(plan.from_h)):
        if plan.from_h[entry] >= 0:
            k_values[plan.from_h[entry]] += program.h_values[entry]
    for entry in range(len(plan.from_a)):
        k_values[plan.from_a[entry]] += found.jacobian[entry]
    for row in range(len(at.t_lower)):
        stiffness = at.w_lower[row] / (at.t_lower[row] + elastic * at.w_lower[row])
        stiffness += at.w_upper[row] / (at.t_upper[row] + elastic * at.w_upper[row])
        for pair in range(plan.pair_begins[row], plan.pair_begins[row + 1]):
            k_values[plan.pair_places[pair]] += stiffness * pair_products[pair]


@compiled
def newton_step(
    program: ProgramArrays,
    plan: KktPlan,
    at: Iterate,
    found: Residuals,
    settings: Settings,
    target: float,
    correct: bool,
    work: Workspace,
    step: Iterate,
) -> None:
    """Write the step towards complementarity ``target`` to ``step``.

    Args:
        program: the program.
        plan: places in the matrix.
        at: where the step begins.
        found: residuals there.
        settings: numbers that steer the method.
        target: complementarity of each pair of slack and multiplier after the step.
        correct: whether ``step`` holds a predictor whose second-order error is to be made up for (Mehrotra).
        work: factors of the matrix.
        step: result.
    """
    _right_hand_side(program, at, found, settings, target, correct, work, step)
    order, size = plan.elimination.order, len(at.z)
    for k in range(len(order)):
        index = order[k]
        work.permuted[k] = step.z[index] if index < size else -found.equality[index - size]
    solve_in_place(plan.elimination, work.l_values, work.inverse_pivots, work.permuted)
    for k in range(len(order)):
        index = order[k]
        if index < size:
            step.z[index] = work.permuted[k]
        else:
            step.y[index - size] = work.permuted[k]
    _slack_steps(program, at, found, settings, work, step)


@compiled
def _right_hand_side(
    program: ProgramArrays,
    at: Iterate,
    found: Residuals,
    settings: Settings,
    target: float,
    correct: bool,
    work: Workspace,
    step: Iterate,
) -> None:
    """Write the right-hand side of the rows of the unknowns to ``step.z``."""
    elastic = settings.elastic
    for column in range(len(step.z)):
        step.z[column] = -found.dual[column]
    for row in range(len(at.t_lower)):
        force = 0.0
        t, w = at.t_lower[row], at.w_lower[row]
        if program.has_lower[row]:
            second = step.t_lower[row] * step.w_lower[row] if correct else 0.0
            work.e_lower[row] = target - second - w * t
            force += (work.e_lower[row] + w * found.lower[row]) / (t + elastic * w)
        t, w = at.t_upper[row], at.w_upper[row]
        if program.has_upper[row]:
            second = step.t_upper[row] * step.w_upper[row] if correct else 0.0
            work.e_upper[row] = target - second - w * t
            force -= (work.e_upper[row] + w * found.upper[row]) / (t + elastic * w)
        for entry in range(program.g_begins[row], program.g_begins[row + 1]):
            step.z[program.g_columns[entry]] += program.g_values[entry] * force


@compiled
def _slack_steps(
    program: ProgramArrays, at: Iterate, found: Residuals, settings: Settings, work: Workspace, step: Iterate
) -> None:
    """Write the steps of slacks and their multipliers, which follow from ``step.z``."""
    elastic = settings.elastic
    for row in range(len(at.t_lower)):
        change = 0.0
        for entry in range(program.g_begins[row], program.g_begins[row + 1]):
            change += program.g_values[entry] * step.z[program.g_columns[entry]]
        if program.has_lower[row]:
            t, w = at.t_lower[row], at.w_lower[row]
            step.w_lower[row] = (work.e_lower[row] + w * (found.lower[row] - change)) / (t + elastic * w)
            step.t_lower[row] = change + elastic * step.w_lower[row] - found.lower[row]
        if program.has_upper[row]:
            t, w = at.t_upper[row], at.w_upper[row]
            step.w_upper[row] = (work.e_upper[row] + w * (found.upper[row] + change)) / (t + elastic * w)
            step.t_upper[row] = -change + elastic * step.w_upper[row] - found.upper[row]
