"""Weighted whole-body control: the tasks of the hierarchy in one quadratic program; limits stay hard."""

from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from quadlab.configuration import Positive, register
from quadlab.controllers.decision_space import DecisionSpace
from quadlab.controllers.formulation import FORMULATIONS, constraint_names
from quadlab.controllers.hierarchical import resolve_levels
from quadlab.controllers.hierarchy import StackedLevels
from quadlab.controllers.level_solver import WEIGHTED, LevelledControllerConfig, LevelSolver
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.resolver import Resolution
from quadlab.controllers.task_stack import TaskStack
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics


@register("controller", "weighted")
class WeightedResolver:
    """min sum_k weight_k |A_k x - b_k|^2 under hard dynamics, contacts and limits.

    The same levels as ``hierarchical``: those without a weight are limits, in their order (torque limits always have a
    solution; friction gives way only to them), the others share one objective.
    """

    class Config(LevelledControllerConfig):
        """Tasks, weights and tracking; levels without a weight come first.

        Attributes:
            weights: of the squared residuals, by level name.
        """

        kind: Literal["weighted"]
        weights: Annotated[dict[str, Positive], Field(min_length=1)]

        @model_validator(mode="after")
        def _weights_name_the_last_levels(self) -> Self:
            names = [level.name for level in self.levels]
            if set(names[len(names) - len(self.weights) :]) != set(self.weights):
                raise ValueError(
                    f"weights must name the last levels, all limits before them; "
                    f"levels are {', '.join(names)}, weights name {', '.join(self.weights)}"
                )
            return self

    def __init__(self, config: Config) -> None:
        self.config = config
        self._stack = TaskStack(config.levels)
        self._formulate = FORMULATIONS[config.formulation]
        names = (*constraint_names(config.formulation), *self._stack.names)
        self._limits = len(names) - len(config.weights)
        self._roots = np.sqrt([config.weights[name] for name in names[self._limits :]])
        self.level_names = (*names[: self._limits], WEIGHTED)
        self.limit_names = tuple(name for name in config.limit_names if name not in config.weights)
        self._solver = LevelSolver(config, self.level_names)

    def resolve(self, kinematics: Kinematics, reference: ControlReference, last_torques: Array) -> Resolution:
        """Return the torques of the weighted optimum."""
        space, levels = self.assemble(kinematics, reference)
        return resolve_levels(self._solver, levels, space, reference, last_torques)

    def assemble(self, kinematics: Kinematics, reference: ControlReference) -> tuple[DecisionSpace, StackedLevels]:
        """Return the decision space of a tick, the limits and the weighted level in it, without solving them."""
        space = self._formulate(kinematics, reference.stance_legs)
        return space, self._merged(self._stack.assemble(kinematics, reference, space))

    def _merged(self, levels: StackedLevels) -> StackedLevels:
        """Scale the weighted levels by the roots of their weights and make one level of them."""
        breaks = levels.breaks
        scale = np.ones(breaks[-1])
        scale[breaks[self._limits] :] = np.repeat(self._roots, np.diff(breaks[self._limits :]))
        return StackedLevels(
            levels.matrix * scale[:, None],
            levels.lower * scale,
            levels.upper * scale,
            np.concatenate([breaks[: self._limits + 1], breaks[-1:]]),
        )
