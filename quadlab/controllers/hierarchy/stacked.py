"""The compiled entry point: a whole hierarchy in stacked form, from the highest level to the closest minimiser."""

from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

import numpy as np

from quadlab.controllers.hierarchy.active_set import BREAKDOWN, SOLVED, solve_level
from quadlab.controllers.hierarchy.elimination import freeze_level
from quadlab.controllers.hierarchy.factorisation import reflect
from quadlab.controllers.hierarchy.level import IndexArray, SideArray
from quadlab.controllers.hierarchy.step import classify
from quadlab.controllers.hierarchy.workspace import Workspace, allocate, row_tolerance
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry, inlined, source_fingerprint

StackedResult: TypeAlias = tuple[Array, Array, SideArray, int, int]
StackedSolver: TypeAlias = Callable[[Array, Array, Array, IndexArray, Array, int], StackedResult]


@inlined
def append_closest_level(workspace: Workspace, count: int, fixed: int) -> int:
    """Append the implicit last level  min ||x - start||  and return its number of rows, one per free coordinate.

    Rotations keep distances, so that in the free coordinates its rows are unit vectors and its bounds the anchor.
    """
    dimension = len(workspace.point)
    for offset in range(dimension - fixed):
        row = count + offset
        for column in range(dimension):
            workspace.rows[row, column] = 0.0
        workspace.rows[row, fixed + offset] = 1.0
        workspace.norms[row] = 1.0
        workspace.lower[row] = workspace.anchor[fixed + offset]
        workspace.upper[row] = workspace.anchor[fixed + offset]
    return dimension - fixed


@inlined
def rotate_back(workspace: Workspace, fixed: int) -> Array:
    """Return x = Q u."""
    x = workspace.point.copy()
    for index in range(fixed - 1, -1, -1):
        reflect(x, workspace.reflectors[index], workspace.reflector_scales[index], index, len(x))
    return x


@inlined
def assess_rows(matrix: Array, lower: Array, upper: Array, norms: Array, x: Array) -> tuple[Array, SideArray]:
    """Return (slacks, active) of all rows at ``x``, computed from the rows as they were given."""
    slacks = np.zeros(len(lower))
    active = np.zeros(len(lower), np.int8)
    tolerance = row_tolerance(x)
    for row in range(len(lower)):
        value = 0.0
        for column in range(len(x)):
            value += matrix[row, column] * x[column]
        slacks[row] = max(value - upper[row], 0.0) + min(value - lower[row], 0.0)
        if lower[row] == upper[row]:
            active[row] = 2
        elif value >= upper[row] - tolerance * norms[row]:
            active[row] = 1
        elif value <= lower[row] + tolerance * norms[row]:
            active[row] = -1
    return slacks, active


def _compile_solver(fingerprint: int) -> StackedSolver:
    @compiled_entry
    def solve(
        matrix: Array, lower: Array, upper: Array, breaks: IndexArray, start: Array, iteration_limit: int
    ) -> StackedResult:
        _ = fingerprint  # a closure variable, so that the cached machine code follows a change of any file here
        count, dimension = matrix.shape
        levels = len(breaks) - 1
        workspace = allocate(matrix, lower, upper, start)
        fixed, working_count, iterations, status = 0, 0, 0, SOLVED
        for level in range(levels + 1):
            if status != SOLVED or fixed == dimension:
                break
            if level < levels:
                first, last = breaks[level], breaks[level + 1]
            else:
                first, last = count, count + append_closest_level(workspace, count, fixed)
            if not classify(workspace, first, last):
                continue
            working_count, made, status = solve_level(
                workspace, first, last, fixed, working_count, iteration_limit - iterations
            )
            iterations += made
            if level < levels and status == SOLVED:
                fixed, working_count = freeze_level(workspace, first, last, count, fixed, working_count)
        x = rotate_back(workspace, fixed)
        if not np.isfinite(x).all():
            x, status = start.copy(), BREAKDOWN
        slacks, active = assess_rows(matrix, lower, upper, workspace.norms, x)
        return x, slacks, active, iterations, status

    return solve


_solve = _compile_solver(source_fingerprint(Path(__file__).parent))


def solve_stacked(
    matrix: Array, lower: Array, upper: Array, breaks: IndexArray, start: Array, iteration_limit: int
) -> StackedResult:
    """Solve a hierarchy in stacked form; for callers that assemble it themselves and check nothing.

    Among all minimisers of the hierarchy this returns the one closest to ``start``: the shortest step from it, and with
    ``start`` = 0 the solution of least norm. It is unique, whatever path the active set took.

    Args:
        matrix: (m, n) float64, C-contiguous, finite; rows of all levels, highest priority first.
        lower, upper: (m,) float64, lower <= upper, may be infinite; equal for an equality.
        breaks: (levels + 1,) int64, row where each level begins, and m at the end; empty levels are legal.
        start: (n,) float64; a warm start, for example the previous solution. It need not be feasible.
        iteration_limit: iterations over all levels together.

    Returns:
        x: (n,) the solution, finite in any case.
        slacks: (m,) by how much a row lies above (positive) or below (negative) its interval at x.
        active: (m,) int8: 2 equality, +1 at or above the upper bound, -1 at or below the lower one, 0 strictly between.
        iterations: number of iterations made.
        status: 0 solved; 1 iteration limit: higher levels are optimal, the one under way has not got worse than at its
            beginning, lower ones were not looked at; 2 numerical breakdown (overflow): as before, or x is ``start``.
    """
    return _solve(matrix, lower, upper, breaks, start, iteration_limit)
