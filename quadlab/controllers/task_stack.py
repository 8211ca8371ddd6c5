"""Levels of tasks in the form the hierarchical solver reads, written in the decision variables of the tick."""

from collections.abc import Sequence
from itertools import accumulate

import numpy as np

from quadlab.controllers.decision_space import BLOCKS, DecisionSpace
from quadlab.controllers.hierarchy import Level, StackedLevels, stack
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
        self._level_ends = [0, *accumulate(len(level.tasks) for level in levels)]

    def assemble(self, kinematics: Kinematics, reference: ControlReference, space: DecisionSpace) -> StackedLevels:
        """Return all rows of a tick, highest priority first, below the constraints of the decision space."""
        rows = [task.rows(kinematics, reference) for task in self._tasks]
        starts = [0, *accumulate([len(part.lower) for part in rows])]
        matrix, lower, upper = in_decision_variables(rows, space)
        levels = StackedLevels(matrix, lower, upper, np.array([starts[end] for end in self._level_ends]))
        return _below(space.constraints, levels) if space.constraints else levels


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
    """Return matrix, lower and upper of all ``parts``, in their order, in the decision variables.

    The rows are written in y = [u_dot, tau, lambda] first, so that one product takes all of them to x.
    """
    lower = np.concatenate([part.lower for part in parts])
    upper = np.concatenate([part.upper for part in parts])
    wide = np.zeros((len(lower), len(space.offset)))
    first = 0
    for part in parts:
        last = first + len(part.lower)
        wide[first:last, BLOCKS[part.variable]] = part.matrix
        first = last
    return _substitute(wide, space.linear, space.offset, lower, upper), lower, upper


@compiled_entry
def _substitute(wide: Array, linear: Array, offset: Array, lower: Array, upper: Array) -> Array:
    """Return wide @ linear, and take wide @ offset from ``lower`` and ``upper``; most entries of ``wide`` are zero."""
    rows, columns = len(wide), linear.shape[1]
    matrix = np.zeros((rows, columns))
    for row in range(rows):
        for k in range(wide.shape[1]):
            weight = wide[row, k]
            if weight != 0.0:
                for column in range(columns):
                    matrix[row, column] += weight * linear[k, column]
                lower[row] -= weight * offset[k]
                upper[row] -= weight * offset[k]
    return matrix
