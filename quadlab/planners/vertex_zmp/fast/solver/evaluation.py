"""Values and residuals of a bilinear program at an iterate."""

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.solver.jit import compiled
from quadlab.planners.vertex_zmp.fast.solver.numbers import ProgramArrays
from quadlab.planners.vertex_zmp.fast.solver.state import Iterate, Residuals


@compiled
def evaluate(program: ProgramArrays, at: Iterate, elastic: float, out: Residuals) -> None:
    """Fill ``out`` at the iterate ``at``."""
    _equalities(program, at.z, out.equality, out.jacobian)
    inequality_values(program, at.z, out.values)
    _dual(program, at, out)
    if elastic > 0.0:
        for row in range(len(at.y)):
            out.equality[row] -= elastic * at.y[row]
    for row in range(len(out.values)):
        if program.has_lower[row]:
            distance = out.values[row] - program.lower[row]
            out.lower[row] = at.t_lower[row] - distance - elastic * at.w_lower[row]
        if program.has_upper[row]:
            distance = program.upper[row] - out.values[row]
            out.upper[row] = at.t_upper[row] - distance - elastic * at.w_upper[row]


@compiled
def _equalities(program: ProgramArrays, z: Array, values: Array, jacobian: Array) -> None:
    for row in range(len(values)):
        values[row] = -program.right[row]
    a_begins, a_rows, a_values = program.a_begins, program.a_rows, program.a_values
    for column in range(len(z)):
        for entry in range(a_begins[column], a_begins[column + 1]):
            values[a_rows[entry]] += a_values[entry] * z[column]
            jacobian[entry] = a_values[entry]
    for p in range(len(program.p_rows)):
        weight = program.p_coefficients[p]
        a, b = z[program.p_first[p]], z[program.p_second[p]]
        values[program.p_rows[p]] += weight * a * b
        jacobian[program.p_by_first[p]] += weight * b
        jacobian[program.p_by_second[p]] += weight * a


@compiled
def inequality_values(program: ProgramArrays, z: Array, values: Array) -> None:
    """Write G z to ``values``."""
    g_begins, g_columns, g_values = program.g_begins, program.g_columns, program.g_values
    for row in range(len(values)):
        total = 0.0
        for entry in range(g_begins[row], g_begins[row + 1]):
            total += g_values[entry] * z[g_columns[entry]]
        values[row] = total


@compiled
def _dual(program: ProgramArrays, at: Iterate, out: Residuals) -> None:
    """Write h + H z + J' y - G' (w_lower - w_upper) to ``out.dual``."""
    z, dual = at.z, out.dual
    for column in range(len(z)):
        dual[column] = program.gradient[column]
    for column in range(len(z)):
        for entry in range(program.h_begins[column], program.h_begins[column + 1]):
            dual[program.h_rows[entry]] += program.h_values[entry] * z[column]
        total = 0.0
        for entry in range(program.a_begins[column], program.a_begins[column + 1]):
            total += out.jacobian[entry] * at.y[program.a_rows[entry]]
        dual[column] += total
    for row in range(len(at.w_lower)):
        force = at.w_lower[row] - at.w_upper[row]
        if force != 0.0:
            for entry in range(program.g_begins[row], program.g_begins[row + 1]):
                dual[program.g_columns[entry]] -= program.g_values[entry] * force


@compiled
def largest_quadratic_change(program: ProgramArrays, step: Array, change: Array) -> float:
    """Return the largest component of products(step), by which a full step misses the linearised equalities."""
    change[:] = 0.0
    for p in range(len(program.p_rows)):
        product = step[program.p_first[p]] * step[program.p_second[p]]
        change[program.p_rows[p]] += program.p_coefficients[p] * product
    return float(np.abs(change).max()) if len(change) else 0.0
