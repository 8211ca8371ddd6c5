"""The Newton direction of the conditions of optimality."""

from quadlab.planners.vertex_zmp.fast.solver.factor import solve_in_place
from quadlab.planners.vertex_zmp.fast.solver.jit import compiled
from quadlab.planners.vertex_zmp.fast.solver.kkt import KktPlan
from quadlab.planners.vertex_zmp.fast.solver.matrix import Workspace
from quadlab.planners.vertex_zmp.fast.solver.numbers import ProgramArrays
from quadlab.planners.vertex_zmp.fast.solver.state import Iterate, Residuals, Settings


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
