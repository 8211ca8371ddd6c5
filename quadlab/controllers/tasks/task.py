"""A task: linear rows in accelerations, torques or contact forces (Bellicoso 2016, Eq. 8)."""

from enum import StrEnum
from typing import NamedTuple, Protocol

import numpy as np

from quadlab.controllers.reference import ControlReference
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics


class Variable(StrEnum):
    """The block of the decision vector that rows are written in."""

    ACCELERATION = "acceleration"
    """Generalised acceleration u_dot, (18,): base linear and angular in base axes, then joints."""
    TORQUE = "torque"
    """Joint torques tau, (12,) in [N m]."""
    FORCE = "force"
    """Contact forces lambda of the standing legs in world axes, (3 n_stance,) in [N]."""


class TaskRows(NamedTuple):
    """Rows lower <= matrix x <= upper of one variable block; equal bounds make an equation.

    A named tuple, since it is made for every task in every tick and takes a third of the time of a frozen dataclass.

    Attributes:
        variable: the block x.
        matrix: (m, n).
        lower, upper: (m,), infinite where there is no bound.
    """

    variable: Variable
    matrix: Array
    lower: Array
    upper: Array


def empty_rows(variable: Variable, count: int, size: int) -> TaskRows:
    """Return ``count`` inequalities in ``size`` unknowns with arbitrary numbers, to be written to in each tick."""
    return TaskRows(variable, np.empty((count, size)), np.empty(count), np.empty(count))


def empty_equation(variable: Variable, count: int, size: int) -> TaskRows:
    """Return ``count`` equations in ``size`` unknowns with arbitrary numbers, to be written to in each tick."""
    return equation(variable, np.empty((count, size)), np.empty(count))


def equation(variable: Variable, matrix: Array, target: Array) -> TaskRows:
    """Return the rows of ``matrix`` x = ``target``."""
    return TaskRows(variable, matrix, target, target)


class Task(Protocol):
    """One objective or limit; it knows its gains, not its priority."""

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return the rows of this tick; no rows (m = 0) if nothing is asked.

        A task may write to the same arrays in every tick, so that rows are valid until the next call.
        """
        ...
