"""Priorities as data: levels of named tasks in a controller's YAML."""

from typing import Annotated, Any

from pydantic import PlainSerializer, PlainValidator, field_validator

from quadlab.configuration import StrictModel, registered, without_defaults
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
    if isinstance(value, StrictModel):
        return value
    name = value.get("task") if isinstance(value, dict) else None
    known = registered("task")
    if not isinstance(name, str) or name not in known:
        raise ValueError(f"unknown task {name!r}; known: {', '.join(sorted(known))}")
    config: StrictModel = known[name].Config.model_validate(value)  # type: ignore[attr-defined]
    return config


TaskConfig = Annotated[StrictModel, PlainValidator(_validate), PlainSerializer(without_defaults, return_type=dict)]
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
