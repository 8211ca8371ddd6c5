"""Hierarchical whole-body control: strict priorities, solved in the joint torques (Bellicoso 2016; Gehring 2017)."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field, field_validator

from quadlab.configuration import register
from quadlab.controllers.controller_config import TrackingControllerConfig
from quadlab.controllers.hierarchy import StackedLevels, solve_stacked
from quadlab.controllers.reduced_dynamics import ReducedDynamics, reduce_dynamics
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.resolver import Resolution
from quadlab.controllers.task_levels import LevelConfig, check_level_names
from quadlab.controllers.task_stack import TaskStack
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import LEG_COUNT

_ITERATION_LIMIT = 500


@register("controller", "hierarchical")
class HierarchicalResolver:
    """Levels of tasks in strict order; equations of motion and standing contacts stand above all of them."""

    class Config(TrackingControllerConfig):
        """Priorities, gains and tracking.

        Attributes:
            levels: highest priority first; names are unique.
        """

        kind: Literal["hierarchical"]
        levels: Annotated[tuple[LevelConfig, ...], Field(min_length=1)]

        @field_validator("levels")
        @classmethod
        def _unique_names(cls, levels: tuple[LevelConfig, ...]) -> tuple[LevelConfig, ...]:
            return check_level_names(levels)

    def __init__(self, config: Config) -> None:
        self.config = config
        self._stack = TaskStack(config.levels)
        self.level_names = self._stack.names

    def resolve(self, kinematics: Kinematics, reference: ControlReference, last_torques: Array) -> Resolution:
        """Return the torques that satisfy the levels in their order; what these leave open stays as it was."""
        dynamics = reduce_dynamics(kinematics, reference.stance_legs)
        levels = self._stack.assemble(kinematics, reference, dynamics)
        return resolve_levels(self.level_names, levels, dynamics, reference, last_torques)


def resolve_levels(
    names: tuple[str, ...],
    levels: StackedLevels,
    dynamics: ReducedDynamics,
    reference: ControlReference,
    last_torques: Array,
) -> Resolution:
    """Solve stacked levels in the torques and say what follows from them.

    Args:
        names: of the levels.
        levels: in torques, highest priority first.
        dynamics: of the tick.
        reference: for the standing legs.
        last_torques: start of the solver, (12,) in [N m].
    """
    torques, slacks, _, iterations, code = solve_stacked(
        levels.matrix, levels.lower, levels.upper, levels.breaks, last_torques, _ITERATION_LIMIT
    )
    parts = np.split(slacks, levels.breaks[1:-1])
    forces = np.zeros((LEG_COUNT, 3))
    forces[reference.stance_legs] = dynamics.forces(torques)
    return Resolution(
        torques=torques,
        accelerations=dynamics.accelerations(torques),
        contact_forces=forces,
        residuals={name: float(np.linalg.norm(part)) for name, part in zip(names, parts, strict=True)},
        iterations=iterations,
        solved=code == 0,
    )
