"""Levels of tasks in the form the hierarchical solver reads, written in the decision variables of the tick."""

from collections.abc import Sequence
from functools import cache
from itertools import accumulate

import numpy as np

from quadlab.controllers.decision_space import DecisionSpace, columns
from quadlab.controllers.hierarchy import Level, StackedLevels, stack
from quadlab.controllers.hierarchy.level import IndexArray
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.task_levels import LevelConfig, build_task
from quadlab.controllers.tasks.task import TaskRows
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry
from quadlab.robots.kinematics import Kinematics


class TaskStack:
    """Tasks in order of priority."""

    def __init__(self, levels: Sequence[LevelConfig]) -> None:
        self.names = tuple(level.name for level in levels)
        self._tasks = [build_task(config) for level in levels for config in level.tasks]
        self._level_ends = (0, *accumulate(len(level.tasks) for level in levels))

    def assemble(self, kinematics: Kinematics, reference: ControlReference, space: DecisionSpace) -> StackedLevels:
        """Return all rows of a tick, highest priority first, below the constraints of the decision space."""
        rows = [task.rows(kinematics, reference) for task in self._tasks]
        breaks = level_breaks(tuple([len(part[2]) for part in rows]), self._level_ends)
        levels = StackedLevels(*in_decision_variables(rows, space), breaks)
        return _below(space.constraints, levels) if space.constraints else levels


@cache
def level_breaks(sizes: tuple[int, ...], level_ends: tuple[int, ...]) -> IndexArray:
    """Return the rows where levels begin, (levels + 1,), for tasks of ``sizes`` rows.

    Levels end before the tasks ``level_ends``. There are as many results as ways to stand; they are shared by all ticks
    and must not be written to.
    """
    starts = (0, *accumulate(sizes))
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


def in_decision_variables(parts: Sequence[TaskRows], space: DecisionSpace) -> tuple[Array, Array, Array]:
    """Return matrix, lower and upper of all ``parts``, in their order, in x.

    Raises:
        ValueError: if the shapes of a part do not fit each other or its variable.
    """
    count = sum([len(part[2]) for part in parts])
    result = np.empty((count, space.size)), np.empty(count), np.empty(count)
    blocks, first = columns(len(space.offset)), 0
    for number, part in enumerate(parts):
        if not _substitute(part[1:], blocks[part[0]], (space.linear, space.offset), first, result):
            begin, end = blocks[part.variable]
            raise ValueError(
                f"task {number} of the stack, in {part.variable}: matrix {part.matrix.shape}, "
                f"lower {part.lower.shape}, upper {part.upper.shape}; expected (m, {end - begin}), (m,), (m,)"
            )
        first += len(part[2])
    return result


@compiled_entry
def _substitute(
    part: tuple[Array, Array, Array],
    block: tuple[int, int],
    substitution: tuple[Array, Array],
    first: int,
    result: tuple[Array, Array, Array],
) -> bool:
    """Write lower <= matrix x <= upper from row ``first`` of ``result`` on, for the rows of ``part`` in y.

    Args:
        part: matrix (m, n), most of whose entries are zero, lower and upper (m,) in a part of y.
        block: where this part begins and ends in y = linear x + offset.
        substitution: linear and offset, as in ``DecisionSpace``.
        first: row to write to.
        result: matrix, lower and upper of all tasks.

    Returns:
        Whether the shapes fit; nothing is read or written if they do not.
    """
    rows, row_lower, row_upper = part
    first_column, end_column = block
    linear, offset = substitution
    matrix, lower, upper = result
    if len(row_lower) != len(rows) or len(row_upper) != len(rows) or rows.shape[1] != end_column - first_column:
        return False
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
    return True
