"""The part of a controller that finds torques for the reference of a tick; what controller variants differ in."""

import math
from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np

from quadlab.controllers.reference import ControlReference
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import VELOCITY_SIZE, Kinematics
from quadlab.robots.legs import JOINT_COUNT, LEG_COUNT


class Resolution(NamedTuple):
    """The answer for one tick.

    Attributes:
        torques: (12,) in [N m].
        accelerations: generalised accelerations that the model expects of them, (18,).
        contact_forces: that the model expects, (4, 3) in [N]; zero for legs in the air.
        residuals: norm of the unmet part of each level by name.
        iterations: of the solver.
        solved: whether the solver finished; if not, ``torques`` is not to be used.
        certificate: how far from optimal the torques are, largest over the levels; NaN if it was not asked for.
        reason: why the solver did not finish, in one line; empty if it did.
    """

    torques: Array
    accelerations: Array
    contact_forces: Array
    residuals: dict[str, float]
    iterations: int
    solved: bool
    certificate: float = math.nan
    reason: str = ""


class Resolver(Protocol):
    """What every variant of whole-body control can do."""

    @property
    def level_names(self) -> tuple[str, ...]:
        """Names of the residuals, in order of priority."""
        ...

    @property
    def limit_names(self) -> tuple[str, ...]:
        """Names of the residuals that no tick should have: those of torque and contact-force limits."""
        ...

    def resolve(self, kinematics: Kinematics, reference: ControlReference, last_torques: Array) -> Resolution:
        """Return torques for this tick.

        Args:
            kinematics: measured.
            reference: what shall happen.
            last_torques: of the tick before, (12,) in [N m]; where the solver starts.
        """
        ...


def unsolved(names: Sequence[str], reason: str) -> Resolution:
    """Return the answer of a tick without one."""
    return Resolution(
        torques=np.full(JOINT_COUNT, math.nan),
        accelerations=np.zeros(VELOCITY_SIZE),
        contact_forces=np.zeros((LEG_COUNT, 3)),
        residuals=dict.fromkeys(names, math.nan),
        iterations=0,
        solved=False,
        reason=reason,
    )
