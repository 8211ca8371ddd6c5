"""Priorities as data: levels of named tasks in a controller's YAML."""

from functools import cache
from typing import Annotated, Any

from pydantic import PlainSerializer, PlainValidator, TypeAdapter, field_validator

from quadlab.configuration import PartOf, StrictModel, registered, without_defaults
from quadlab.controllers.limits import (
    friction_cone,
    height_over_footprint,
    joint_position_limits,
    limb_extension,
    torque_limits,
)
from quadlab.controllers.tasks import (
    base_height,
    base_orientation,
    base_position,
    com_position,
    contact_force_minimisation,
    manipulability_height,
    swing_feet,
    swing_joint_hold,
    torque_minimisation,
)
from quadlab.controllers.tasks.task import Task

__all__ = ["LevelConfig", "TaskConfig", "build_task", "check_level_names"]

_TASK_MODULES = (
    base_height,
    base_orientation,
    base_position,
    com_position,
    contact_force_minimisation,
    friction_cone,
    height_over_footprint,
    joint_position_limits,
    limb_extension,
    manipulability_height,
    swing_feet,
    swing_joint_hold,
    torque_limits,
    torque_minimisation,
)
"""Importing a task's module registers it; a new task is added here."""


def _validate(value: Any) -> StrictModel:
    return _union(tuple(registered("task").values())).validate_python(value)


@cache
def _union(_tasks: tuple[type, ...]) -> TypeAdapter[StrictModel]:
    """Return what tells the configurations of the tasks registered now apart; one may be registered at any time."""
    return TypeAdapter(Annotated[StrictModel, _TASK])


_TASK = PartOf("task", key="task")
TaskConfig = Annotated[
    StrictModel, _TASK, PlainValidator(_validate), PlainSerializer(without_defaults, return_type=dict)
]
"""The configuration of any registered task, chosen by its key ``task``."""


class LevelConfig(StrictModel):
    """Tasks of one priority.

    Attributes:
        name: under which residuals are logged.
        tasks: at least one.
    """

    name: str
    tasks: tuple[TaskConfig, ...]

    @field_validator("tasks")
    @classmethod
    def _has_tasks(cls, tasks: tuple[Any, ...]) -> tuple[Any, ...]:
        """Counted here and not by the type, which would count a task with a mistake as missing as well."""
        if not tasks:
            raise ValueError("a level needs at least one task")
        return tasks


def build_task(config: Any) -> Task:
    """Return the task that ``config`` describes."""
    task: Task = registered("task")[config.task](config)
    return task


def check_level_names(levels: tuple[LevelConfig, ...]) -> tuple[LevelConfig, ...]:
    """Return ``levels``; raise ValueError if two have the same name."""
    names = [level.name for level in levels]
    if len(set(names)) != len(names):
        raise ValueError(f"level names must differ; have {', '.join(names)}")
    return levels
