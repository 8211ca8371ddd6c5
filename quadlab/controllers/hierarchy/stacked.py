"""The compiled entry point: a whole hierarchy in stacked form, from the highest level to the closest minimiser."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np

from quadlab.controllers.hierarchy.active_set import BREAKDOWN, SOLVED, solve_level
from quadlab.controllers.hierarchy.elimination import freeze_level
from quadlab.controllers.hierarchy.factorisation import reflect
from quadlab.controllers.hierarchy.level import IndexArray, SideArray
from quadlab.controllers.hierarchy.step import classify
from quadlab.controllers.hierarchy.workspace import Workspace, allocate, row_tolerance
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry, inlined, source_fingerprint

Rows: TypeAlias = tuple[Array, Array, Array, IndexArray]
"""matrix, lower, upper and breaks of ``StackedLevels``."""
Answer: TypeAlias = tuple[Array, Array, SideArray, Array]
"""x, slacks, active and norms of ``StackedResult``."""


class StackedResult(NamedTuple):
    """The answer to a hierarchy in stacked form.

    Attributes:
        x: (n,) the solution, finite in any case.
        slacks: (m,) by how much a row lies above (positive) or below (negative) its interval at x.
        active: (m,) int8: 2 equality, +1 at or above the upper bound, -1 at or below the lower one, 0 strictly between.
        norms: (levels,) of the slacks of each level; NaN where a row has a number that is none or cannot be
            squared: the solver takes comparisons with NaN for satisfied rows, so that its status does not tell.
        iterations: number of iterations made.
        status: 0 solved; 1 iteration limit: higher levels are optimal, the one under way has not got worse than at its
            beginning, lower ones were not looked at; 2 numerical breakdown (overflow): as before, or x is ``start``.
    """

    x: Array
    slacks: Array
    active: SideArray
    norms: Array
    iterations: int
    status: int


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
def rotate_back(workspace: Workspace, fixed: int, x: Array) -> None:
    """Write x = Q u."""
    x[:] = workspace.point
    for index in range(fixed - 1, -1, -1):
        reflect(x, workspace.reflectors[index], workspace.reflector_scales[index], index, len(x))


@inlined
def assess_rows(rows: Rows, row_norms: Array, answer: Answer) -> None:
    """Write slacks and active of all rows at x, computed from the rows as they were given."""
    matrix, lower, upper, _ = rows
    x, slacks, active, _ = answer
    tolerance = row_tolerance(x)
    for row in range(len(lower)):
        value = 0.0
        for column in range(len(x)):
            value += matrix[row, column] * x[column]
        slacks[row] = max(value - upper[row], 0.0) + min(value - lower[row], 0.0)
        active[row] = 0
        if lower[row] == upper[row]:
            active[row] = 2
        elif value >= upper[row] - tolerance * row_norms[row]:
            active[row] = 1
        elif value <= lower[row] + tolerance * row_norms[row]:
            active[row] = -1


@inlined
def assess_levels(rows: Rows, row_norms: Array, answer: Answer) -> None:
    """Write the norm of the slacks of each level; NaN where a row has a number that is none or cannot be squared."""
    _, lower, upper, breaks = rows
    _, slacks, _, norms = answer
    for level in range(len(norms)):
        square = 0.0
        for row in range(breaks[level], breaks[level + 1]):
            square += slacks[row] * slacks[row]
            if np.isnan(lower[row]) or np.isnan(upper[row]) or not np.isfinite(row_norms[row]):
                square = np.nan
        norms[level] = np.sqrt(square)


def _compile_solver(fingerprint: int) -> Callable[[Rows, Array, int, Answer], tuple[int, int]]:
    @compiled_entry
    def solve(rows: Rows, start: Array, iteration_limit: int, answer: Answer) -> tuple[int, int]:
        _ = fingerprint  # a closure variable, so that the cached machine code follows a change of any file here
        matrix, lower, upper, breaks = rows
        x = answer[0]
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
        rotate_back(workspace, fixed, x)
        if not np.isfinite(x).all():
            x[:], status = start, BREAKDOWN
        assess_rows(rows, workspace.norms, answer)
        assess_levels(rows, workspace.norms, answer)
        return iterations, status

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
    """
    rows, dimension = matrix.shape
    answer = np.empty(dimension), np.empty(rows), np.empty(rows, np.int8), np.empty(len(breaks) - 1)
    return StackedResult(*answer, *_solve((matrix, lower, upper, breaks), start, iteration_limit, answer))
