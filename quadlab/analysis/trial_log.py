"""A trial as tables, the way analysis and plots use it."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from quadlab.errors import LogError
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan
from quadlab.planners.plan_io import bytes_to_plan
from quadlab.robots.legs import JOINT_NAMES, LEGS
from quadlab.trials.recording.topics import PLAN_ATTACHMENT

_COMPONENTS = frozenset(("w", "x", "y", "z", "roll", "pitch", "yaw", "a", "b", "c", *JOINT_NAMES, *LEGS))


@dataclass(frozen=True)
class TrialLog:
    """Everything that a log holds but the drawings; tables are indexed by ``time_s``, simulated time in [s].

    Attributes:
        state: columns of /state, the truth.
        estimate: columns of /estimate, what the controller was given; empty if it was given the truth.
        control: columns of /control.
        levels: residual of each level of the controller.
        timing: computing times; empty if the log was written without them.
        events: columns ``level`` (its name) and ``message``.
        attachments: content of the attached files by name.
        metadata: a few words about the trial.
    """

    state: pd.DataFrame
    estimate: pd.DataFrame
    control: pd.DataFrame
    levels: pd.DataFrame
    timing: pd.DataFrame
    events: pd.DataFrame
    attachments: dict[str, bytes]
    metadata: dict[str, str]

    @property
    def plan(self) -> MotionPlan:
        """The motion plan of the trial.

        Raises:
            LogError: if the log has none.
        """
        return bytes_to_plan(self.attachment(PLAN_ATTACHMENT), PLAN_ATTACHMENT)

    def attachment(self, name: str) -> bytes:
        """Return the content of an attached file.

        Raises:
            LogError: if the log has none of that name.
        """
        if name not in self.attachments:
            raise LogError(f"no attachment '{name}'; attached are: {', '.join(sorted(self.attachments))}")
        return self.attachments[name]


def vectors(table: pd.DataFrame, name: str) -> Array:
    """Return the columns of a vector, e.g. "com_reference", "foot_position_LF" or "joint_torque", as (n, d).

    Raises:
        LogError: if ``table`` has no such columns.
    """
    found = [column for column in table.columns if _is_component(column, name)]
    if not found:
        raise LogError(f"no vector '{name}' among the columns {', '.join(table.columns)}")
    return table[found].to_numpy(float)


def leg_vectors(table: pd.DataFrame, name: str) -> Array:
    """Return the vectors of all legs, e.g. "foot_position" or "contact_force_desired", as (n, 4, 3).

    Raises:
        LogError: if ``table`` has no such columns.
    """
    return np.stack([vectors(table, f"{name}_{leg}") for leg in LEGS], axis=1)


def _is_component(column: str, name: str) -> bool:
    return column.startswith(f"{name}_") and column[len(name) + 1 :] in _COMPONENTS
