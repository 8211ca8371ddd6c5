"""Pushes: constant forces on a body for a while."""

from dataclasses import dataclass

import numpy as np
from pydantic import field_validator

from quadlab.configuration import NonNegative, Positive, StrictModel, Vector3
from quadlab.geometry.rotations import Array

BASE_BODY = "base"
"""What a push calls the body that carries the base, whatever the URDF names it."""


class PushConfig(StrictModel):
    """A constant force at the centre of mass of a body, in world axes.

    Attributes:
        body: a link of the URDF, or "base".
        direction: of the force in world axes, of any length but zero, (3,).
        force_n: magnitude in [N].
        start_s: in [s]; takes effect with the first simulation step at or after it.
        duration_s: in [s], a whole multiple of the simulation's timestep.
    """

    body: str
    direction: Vector3
    force_n: NonNegative
    start_s: NonNegative
    duration_s: Positive

    @field_validator("direction")
    @classmethod
    def _has_length(cls, direction: tuple[float, ...]) -> tuple[float, ...]:
        if not any(direction):
            raise ValueError("expected a direction of non-zero length, got (0, 0, 0)")
        return direction

    def link(self, base_link: str) -> str:
        """Return the link of the URDF that it acts on, of a robot whose root link is ``base_link``."""
        return base_link if self.body == BASE_BODY else self.body

    @property
    def force(self) -> Array:
        """The force, (3,) in [N]."""
        direction = np.array(self.direction)
        return np.asarray(self.force_n * direction / np.linalg.norm(direction))


@dataclass(frozen=True)
class ScheduledPush:
    """A push in units of the simulation.

    Attributes:
        body: number of the body in the simulator's model.
        force: in world axes, (3,) in [N].
        first_step: the first step in which it acts.
        end_step: the first step in which it no longer acts.
    """

    body: int
    force: Array
    first_step: int
    end_step: int

    def is_active(self, step: int) -> bool:
        """Return whether the push acts in step number ``step``."""
        return self.first_step <= step < self.end_step
