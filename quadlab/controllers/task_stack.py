"""Levels of tasks in the form the hierarchical solver reads, written in the joint torques."""

from collections.abc import Sequence

import numpy as np

from quadlab.controllers.hierarchy import StackedLevels
from quadlab.controllers.reduced_dynamics import ReducedDynamics
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.task_levels import LevelConfig, build_task
from quadlab.controllers.tasks.task import TaskRows, Variable
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import JOINT_COUNT


class TaskStack:
    """Tasks in order of priority."""

    def __init__(self, levels: Sequence[LevelConfig]) -> None:
        self.names = tuple(level.name for level in levels)
        self._levels = [[build_task(config) for config in level.tasks] for level in levels]

    def assemble(self, kinematics: Kinematics, reference: ControlReference, dynamics: ReducedDynamics) -> StackedLevels:
        """Return all rows of a tick in the torques, highest priority first."""
        rows = [[task.rows(kinematics, reference) for task in tasks] for tasks in self._levels]
        sizes = [sum(len(part.lower) for part in parts) for parts in rows]
        matrix, lower, upper = in_torques([part for parts in rows for part in parts], dynamics)
        return StackedLevels(matrix, lower, upper, np.cumsum([0, *sizes], dtype=np.int64))


def in_torques(parts: Sequence[TaskRows], dynamics: ReducedDynamics) -> tuple[Array, Array, Array]:
    """Return matrix, lower and upper of all ``parts``, in their order, with one product for each kind of variable."""
    starts = np.cumsum([0, *(len(part.lower) for part in parts)])
    matrix = np.empty((starts[-1], JOINT_COUNT))
    lower = np.concatenate([part.lower for part in parts])
    upper = np.concatenate([part.upper for part in parts])
    for variable in Variable:
        chosen = [index for index, part in enumerate(parts) if part.variable is variable]
        if not chosen:
            continue
        linear, offset = dynamics.map_of(variable)
        block = np.concatenate([parts[index].matrix for index in chosen])
        where = np.concatenate([np.arange(starts[index], starts[index + 1]) for index in chosen])
        shift = block @ offset
        matrix[where] = block @ linear
        lower[where] -= shift
        upper[where] -= shift
    return matrix, lower, upper
