"""Levels of tasks in the form the hierarchical solver reads, written in the decision variables of the tick."""

from collections.abc import Sequence
from functools import cache
from itertools import accumulate

import numpy as np
from numba.core.errors import TypingError

from quadlab.controllers.decision_space import DecisionSpace, columns
from quadlab.controllers.hierarchy import Level, StackedLevels, stack
from quadlab.controllers.hierarchy.level import IndexArray
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.task_levels import LevelConfig, build_task
from quadlab.controllers.tasks.task import TaskRows, Variable
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
        ValueError: if the arrays of a part do not fit each other or its variable, or are not contiguous float64.
    """
    count = sum([len(part[2]) for part in parts])
    result = np.empty((count, space.size)), np.empty(count), np.empty(count)
    unknowns = len(space.offset)
    blocks = block_columns(tuple([part[0] for part in parts]), unknowns)
    try:
        misfit = _substitute(tuple([part[1:] for part in parts]), blocks, (space.linear, space.offset), result)
    except TypingError as error:
        raise _unlike_arrays(parts) from error
    if misfit >= 0:
        begin, end = blocks[misfit]
        variable, matrix, lower, upper = parts[misfit]
        raise ValueError(
            f"task {misfit} of the stack, in {variable}: matrix {matrix.shape}, lower {lower.shape}, "
            f"upper {upper.shape}; expected (m, {end - begin}), (m,), (m,)"
        )
    return result


@cache
def block_columns(variables: tuple[Variable, ...], unknowns: int) -> IndexArray:
    """Return where the block of each of ``variables`` begins and ends in y, of ``unknowns`` numbers; (tasks, 2)."""
    return np.array([columns(unknowns)[variable] for variable in variables])


def _unlike_arrays(parts: Sequence[TaskRows]) -> ValueError:
    """Return an error that names the tasks whose arrays compiled code cannot take as a list of like ones."""
    shapes = (("matrix", 2), ("lower", 1), ("upper", 1))
    wrong = [
        f"task {number}: {name} {array.dtype} {array.shape}"
        for number, part in enumerate(parts)
        for (name, dimension), array in zip(shapes, part[1:], strict=True)
        if array.dtype != np.float64 or array.ndim != dimension or not array.flags.carray
    ]
    return ValueError(f"tasks of the stack need writeable, C-contiguous float64 arrays; {', '.join(wrong)}")


@compiled_entry
def _substitute(
    parts: tuple[tuple[Array, Array, Array], ...],
    blocks: IndexArray,
    substitution: tuple[Array, Array],
    result: tuple[Array, Array, Array],
) -> int:
    """Write lower <= matrix x <= upper for the rows of all ``parts`` in y; one call, since calls cost the most.

    Args:
        parts: matrix (m, n), most of whose entries are zero, lower and upper (m,) in a part of y.
        blocks: where these parts begin and end in y = linear x + offset, (parts, 2).
        substitution: linear and offset, as in ``DecisionSpace``.
        result: matrix, lower and upper of all tasks.

    Returns:
        The number of the first part whose shapes do not fit, of which nothing is read; -1 if there is none.
    """
    linear, offset = substitution
    matrix, lower, upper = result
    target = 0
    for number in range(len(parts)):
        rows, row_lower, row_upper = parts[number]
        begin, end = blocks[number]
        if len(row_lower) != len(rows) or len(row_upper) != len(rows) or rows.shape[1] != end - begin:
            return number
        for row in range(len(rows)):
            matrix[target] = 0.0
            lower[target], upper[target] = row_lower[row], row_upper[row]
            for k in range(rows.shape[1]):
                weight = rows[row, k]
                if weight != 0.0:
                    for column in range(matrix.shape[1]):
                        matrix[target, column] += weight * linear[begin + k, column]
                    lower[target] -= weight * offset[begin + k]
                    upper[target] -= weight * offset[begin + k]
            target += 1
    return -1
