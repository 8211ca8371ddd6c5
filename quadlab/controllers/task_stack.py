"""Levels of tasks in the form the hierarchical solver reads, written in the decision variables of the tick."""

from collections.abc import Sequence
from functools import cache
from itertools import accumulate
from typing import TypeAlias

import numpy as np

from quadlab.controllers.decision_space import FIRST_COLUMNS, DecisionSpace, block_size
from quadlab.controllers.hierarchy import Level, StackedLevels, stack
from quadlab.controllers.hierarchy.level import IndexArray
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.task_levels import LevelConfig, build_task
from quadlab.controllers.tasks.task import TaskRows, Variable
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry
from quadlab.robots.kinematics import Kinematics

TaskShapes: TypeAlias = tuple[Variable, tuple[int, ...], tuple[int, ...], tuple[int, ...]]
_AXES = 2


class TaskStack:
    """Tasks in order of priority."""

    def __init__(self, levels: Sequence[LevelConfig]) -> None:
        self.names = tuple(level.name for level in levels)
        self._tasks = [build_task(config) for level in levels for config in level.tasks]
        self._level_ends = (0, *accumulate(len(level.tasks) for level in levels))

    def assemble(self, kinematics: Kinematics, reference: ControlReference, space: DecisionSpace) -> StackedLevels:
        """Return all rows of a tick, highest priority first, below the constraints of the decision space."""
        rows = [task.rows(kinematics, reference) for task in self._tasks]
        shapes = tuple([(part[0], part[1].shape, part[2].shape, part[3].shape) for part in rows])
        starts = row_starts(shapes, len(space.offset))
        levels = StackedLevels(*in_decision_variables(rows, starts, space), level_breaks(starts, self._level_ends))
        return _below(space.constraints, levels) if space.constraints else levels


@cache
def row_starts(tasks: tuple[TaskShapes, ...], unknowns: int) -> tuple[int, ...]:
    """Return where the rows of each task begin, and their number at the end.

    Args:
        tasks: variable and shapes of matrix, lower and upper of each task.
        unknowns: size of y in ``DecisionSpace``.

    Raises:
        ValueError: if shapes do not fit each other or the variable; compiled code that reads them would not say so.
    """
    for number, (variable, matrix, lower, upper) in enumerate(tasks):
        columns = block_size(variable, unknowns)
        if len(matrix) != _AXES or matrix[1] != columns or lower != matrix[:1] or upper != lower:
            raise ValueError(
                f"task {number} of the stack, in {variable}: matrix {matrix}, lower {lower}, upper {upper}; "
                f"expected (m, {columns}), (m,), (m,)"
            )
    return (0, *accumulate(matrix[0] for _, matrix, _, _ in tasks))


@cache
def level_breaks(starts: tuple[int, ...], level_ends: tuple[int, ...]) -> IndexArray:
    """Return the rows where levels begin, (levels + 1,), for levels that end before the tasks ``level_ends``.

    There are as many results as ways to stand; they are shared by all ticks and must not be written to.
    """
    return np.array([starts[end] for end in level_ends])


def _below(constraints: Sequence[Level], levels: StackedLevels) -> StackedLevels:
    """Return ``levels`` with ``constraints`` on top."""
    top = stack(constraints)
    return StackedLevels(
        np.concatenate([top.matrix, levels.matrix]),
        np.concatenate([top.lower, levels.lower]),
        np.concatenate([top.upper, levels.upper]),
        np.concatenate([top.breaks[:-1], top.breaks[-1] + levels.breaks]),
    )


def in_decision_variables(
    parts: Sequence[TaskRows], starts: Sequence[int], space: DecisionSpace
) -> tuple[Array, Array, Array]:
    """Return matrix, lower and upper of all ``parts``, in their order and from row ``starts`` on, in x."""
    count = starts[-1]
    result = np.empty((count, space.size)), np.empty(count), np.empty(count)
    for part, first in zip(parts, starts, strict=False):
        _substitute(part[1:], FIRST_COLUMNS[part.variable], (space.linear, space.offset), first, result)
    return result


@compiled_entry
def _substitute(
    part: tuple[Array, Array, Array],
    first_column: int,
    substitution: tuple[Array, Array],
    first: int,
    result: tuple[Array, Array, Array],
) -> None:
    """Write lower <= matrix x <= upper from row ``first`` of ``result`` on, for the rows of ``part`` in y.

    Args:
        part: matrix (m, n), most of whose entries are zero, lower and upper (m,) in a part of y.
        first_column: where this part stands in y = linear x + offset.
        substitution: linear and offset, as in ``DecisionSpace``.
        first: row to write to.
        result: matrix, lower and upper of all tasks.
    """
    rows, row_lower, row_upper = part
    linear, offset = substitution
    matrix, lower, upper = result
    for row in range(len(rows)):
        target = first + row
        matrix[target] = 0.0
        lower[target], upper[target] = row_lower[row], row_upper[row]
        for k in range(rows.shape[1]):
            weight = rows[row, k]
            if weight != 0.0:
                for column in range(matrix.shape[1]):
                    matrix[target, column] += weight * linear[first_column + k, column]
                lower[target] -= weight * offset[first_column + k]
                upper[target] -= weight * offset[first_column + k]
