"""Decision variables of a tick: how accelerations, torques and contact forces follow from them."""

from functools import cache
from typing import NamedTuple

import numpy as np

from quadlab.controllers.hierarchy import Level
from quadlab.controllers.tasks.task import Variable
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import VELOCITY_SIZE
from quadlab.robots.legs import JOINT_COUNT

_ACCELERATIONS = slice(0, VELOCITY_SIZE)
_TORQUES = slice(VELOCITY_SIZE, VELOCITY_SIZE + JOINT_COUNT)
_FORCES = slice(VELOCITY_SIZE + JOINT_COUNT, None)


@cache
def columns(unknowns: int) -> dict[Variable, tuple[int, int]]:
    """Return where each variable begins and ends in y = [u_dot (18), tau (12), lambda], of ``unknowns`` numbers."""
    forces = VELOCITY_SIZE + JOINT_COUNT
    return {
        Variable.ACCELERATION: (0, VELOCITY_SIZE),
        Variable.TORQUE: (VELOCITY_SIZE, forces),
        Variable.FORCE: (forces, unknowns),
    }


class DecisionSpace(NamedTuple):
    """The affine map y = linear @ x + offset from the decision variables x to y = [u_dot, tau, lambda].

    Attributes:
        linear: (30 + 3 n, d).
        offset: (30 + 3 n,).
        constraints: what x has to obey above all tasks, as levels in x; none if the map itself takes care of it.
    """

    linear: Array
    offset: Array
    constraints: tuple[Level, ...] = ()

    @property
    def size(self) -> int:
        """Number of decision variables, d."""
        return int(self.linear.shape[1])

    def values(self, x: Array) -> tuple[Array, Array, Array]:
        """Return u_dot (18,), tau (12,) in [N m] and lambda (n, 3) in [N] for the decision variables ``x`` (d,)."""
        y = np.dot(self.linear, x)
        y += self.offset
        return y[_ACCELERATIONS], y[_TORQUES], y[_FORCES].reshape(-1, 3)

    def accelerations(self, x: Array) -> Array:
        """Return u_dot, (18,)."""
        return self.values(x)[0]

    def torques(self, x: Array) -> Array:
        """Return tau, (12,) in [N m]."""
        return self.values(x)[1]

    def forces(self, x: Array) -> Array:
        """Return lambda of the standing legs, (n, 3) in [N]."""
        return self.values(x)[2]

    def nearest(self, torques: Array) -> Array:
        """Return decision variables, (d,), whose torques are as close to ``torques`` (12,) as possible."""
        if self.size == JOINT_COUNT:
            return torques
        rows, target = self.linear[_TORQUES], torques - self.offset[_TORQUES]
        return np.asarray(np.linalg.lstsq(rows, target, rcond=None)[0], dtype=np.float64)
