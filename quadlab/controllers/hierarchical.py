"""Hierarchical whole-body control: tasks in strict order of priority (Bellicoso 2016; Gehring 2017)."""

from typing import Literal

import numpy as np

from quadlab.configuration import register
from quadlab.controllers.decision_space import DecisionSpace
from quadlab.controllers.formulation import FORMULATIONS, constraint_names
from quadlab.controllers.hierarchy import StackedLevels
from quadlab.controllers.level_solver import LevelledControllerConfig, LevelSolver
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.resolver import Resolution
from quadlab.controllers.task_stack import TaskStack
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import LEG_COUNT


@register("controller", "hierarchical")
class HierarchicalResolver:
    """Levels of tasks in strict order; equations of motion and standing contacts stand above all of them."""

    class Config(LevelledControllerConfig):
        """Priorities, gains and tracking."""

        kind: Literal["hierarchical"]

    def __init__(self, config: Config) -> None:
        self.config = config
        self._stack = TaskStack(config.levels)
        self._formulate = FORMULATIONS[config.formulation]
        self.level_names = (*constraint_names(config.formulation), *self._stack.names)
        self.limit_names = config.limit_names
        self._solver = LevelSolver(config, self.level_names)

    def resolve(self, kinematics: Kinematics, reference: ControlReference, last_torques: Array) -> Resolution:
        """Return the torques that satisfy the levels in their order; what these leave open stays as it was."""
        space, levels = self.assemble(kinematics, reference)
        return resolve_levels(self._solver, levels, space, reference, last_torques)

    def assemble(self, kinematics: Kinematics, reference: ControlReference) -> tuple[DecisionSpace, StackedLevels]:
        """Return the decision space of a tick and all levels in it, without solving them."""
        space = self._formulate(kinematics, reference.stance_legs)
        return space, self._stack.assemble(kinematics, reference, space)


def resolve_levels(
    solver: LevelSolver,
    levels: StackedLevels,
    space: DecisionSpace,
    reference: ControlReference,
    last_torques: Array,
) -> Resolution:
    """Solve stacked levels and say what follows from them.

    Args:
        solver: method.
        levels: in the decision variables, highest priority first.
        space: of the decision variables.
        reference: for the standing legs.
        last_torques: start of the solver, (12,) in [N m].
    """
    solution = solver.solve(levels, space.nearest(last_torques))
    accelerations, torques, standing_forces = space.values(solution.x)
    forces = np.zeros((LEG_COUNT, 3))
    forces[reference.stance] = standing_forces
    return Resolution(
        torques=torques,
        accelerations=accelerations,
        contact_forces=forces,
        residuals=solution.residuals,
        iterations=solution.iterations,
        solved=solution.solved,
        certificate=solution.certificate,
        reason=solution.reason,
    )
