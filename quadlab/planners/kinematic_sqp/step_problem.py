"""The quadratic program of one step with only those rows that matter."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, csr_array, vstack

from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.elimination import Elimination
from quadlab.planners.kinematic_sqp.program import Linearisation
from quadlab.planners.kinematic_sqp.qp.problem import QpSolver, QuadraticProgram, residual
from quadlab.planners.kinematic_sqp.term import Inequality

_MARGIN = 1e-9  # a row counts as violated beyond it, in its own unit
_MAX_ROUNDS = 20


@dataclass(frozen=True)
class InequalityRows:
    """All inequalities as rows of the free variables.

    Attributes:
        matrix: (m, size of y).
        lower, upper: (m,).
        often_active: which rows every quadratic program holds, (m,) flags.
    """

    matrix: csr_array
    lower: Array
    upper: Array
    often_active: Array


@dataclass(frozen=True)
class Step:
    """A step of the free variables.

    Attributes:
        step: (size of y,).
        residual: of the optimality conditions of its quadratic program, see ``qp.problem.residual``.
    """

    step: Array
    residual: float


def inequality_rows(inequalities: Sequence[Inequality], elimination: Elimination) -> InequalityRows:
    """Return lower <= A (T y + p_0) <= upper as rows of y, without those that no y changes."""
    matrix = csr_array(vstack([inequality.matrix for inequality in inequalities], format="csr"))
    offset = matrix @ elimination.constant
    reduced = csr_array(matrix @ elimination.matrix)
    reduced.eliminate_zeros()
    free = np.diff(reduced.indptr) > 0
    often = np.concatenate([np.full(len(each.lower), each.often_active) for each in inequalities])
    lower = np.concatenate([each.lower for each in inequalities]) - offset
    upper = np.concatenate([each.upper for each in inequalities]) - offset
    return InequalityRows(csr_array(reduced[free]), lower[free], upper[free], often[free])


def find_step(model: Linearisation, rows: InequalityRows, y: Array, solver: QpSolver, tolerance: float) -> Step:
    """Return the minimiser of the model within all inequalities.

    The quadratic program begins with the rows that are often active; rows that its answer violates join until there
    are none, which is the answer of the whole program.

    Args:
        model: of the objective at ``y``.
        rows: the inequalities.
        y: the iterate.
        solver: of sparse quadratic programs.
        tolerance: asked of the solver.
    """
    value = rows.matrix @ y
    lower, upper = rows.lower - value, rows.upper - value
    active = rows.often_active.astype(bool)
    for _ in range(_MAX_ROUNDS):
        chosen = csc_array(rows.matrix[active])
        chosen.sort_indices()
        program = QuadraticProgram(model.hessian, model.gradient, chosen, lower[active], upper[active])
        answer = solver.solve(program, tolerance)
        move = rows.matrix @ answer.step
        missed = ~active & ((move < lower - _MARGIN) | (move > upper + _MARGIN))
        if not missed.any():
            return Step(answer.step, residual(program, answer))
        active = active | missed
    return Step(answer.step, float("inf"))
