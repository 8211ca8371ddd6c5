"""Rows of motion tasks in the control frame, which leans with the ground (Gehring 2017, III-C; Bellicoso 2016, IV-A).

Its axes are heading, lateral and normal of the ground. A plan is made for level ground and is laid on the ground that
there is: planned velocities and accelerations are parallel to it.

A deviation from Bellicoso 2016: errors are written in the axes of this tick, and how fast these turn is left out. The
ground's plane is filtered and the heading planned, so that it is slow.
"""

from enum import StrEnum

from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.gains import TrackingGains
from quadlab.controllers.tasks.task import TaskRows
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled, compiled_entry
from quadlab.robots.kinematics import Kinematics

NORMAL_ROW = 2
"""The axis of the control frame that is normal to the ground."""


class Frame(StrEnum):
    """Axes that the rows of a task are written in."""

    WORLD = "world"
    CONTROL = "control"
    """Heading, lateral and normal of the ground."""


class FramedGains(TrackingGains):
    """Gains of a motion, and in which axes it is followed.

    Attributes:
        frame: world or control.
    """

    frame: Frame = Frame.WORLD


@compiled
def _project(
    axes: Array, first: int, jacobian: Array, target: Array | tuple[float, float, float], rows: tuple[Array, Array]
) -> None:
    """Write J (m, n) and target (m,) of the axes from number ``first`` on to ``rows``; axes are columns of (3, 3)."""
    matrix, projected = rows
    for row in range(len(matrix)):
        x, y, z = axes[0, first + row], axes[1, first + row], axes[2, first + row]
        projected[row] = x * target[0] + y * target[1] + z * target[2]
        for column in range(matrix.shape[1]):
            matrix[row, column] = x * jacobian[0, column] + y * jacobian[1, column] + z * jacobian[2, column]


@compiled_entry
def write_turned_rows(axes: Array, first: int, jacobian: Array, target: Array, rows: tuple[Array, Array]) -> None:
    """Write rows of ``jacobian`` u_dot = ``target`` along some of ``axes``.

    Args:
        axes: columns in world components, (3, 3).
        first: number of the axis of the first row.
        jacobian: in world axes, (3, n).
        target: what it shall be, in world axes, (3,).
        rows: matrix (m, n) and right-hand side (m,) to write to.
    """
    _project(axes, first, jacobian, target, rows)


@compiled
def _commanded(
    proportional: float,
    derivative: float,
    planned: tuple[float, float, float],
    measured: tuple[Array, Array, Array],
    axis: int,
) -> float:
    """Return what J u_dot shall be along a world axis."""
    acceleration: float = planned[0] - measured[0][axis]
    velocity: float = planned[1] - measured[1][axis]
    position: float = planned[2] - measured[2][axis]
    return acceleration + derivative * velocity + proportional * position


@compiled_entry
def write_motion_over_ground(
    gains: tuple[float, float],
    axes: Array,
    first: int,
    planned: tuple[Array, Array, Array],
    heave: tuple[float, float, float],
    measured: tuple[Array, Array, Array],
    jacobian: Array,
    rows: tuple[Array, Array],
) -> None:
    """Write rows that follow a planned motion of a point over the ground, along some axes of the control frame.

    Args:
        gains: proportional in [1/s^2] and derivative in [1/s].
        axes: columns heading, lateral and normal in world components, (3, 3).
        first: number of the axis of the first row.
        planned: acceleration, velocity and position as seen from above, x and y first, (2,) or more.
        heave: acceleration and velocity of the height over the ground, and the height in the world.
        measured: J_dot u, velocity and position in world axes, (3,) each.
        jacobian: J of the point in world axes, (3, n) or more rows.
        rows: matrix (m, n) and right-hand side (m,) to write to.
    """
    proportional, derivative = gains
    uphill_x, uphill_y = -axes[0, 2] / axes[2, 2], -axes[1, 2] / axes[2, 2]
    planned_x = planned[0][0], planned[1][0], planned[2][0]
    planned_y = planned[0][1], planned[1][1], planned[2][1]
    planned_z = (
        heave[0] + uphill_x * planned_x[0] + uphill_y * planned_y[0],
        heave[1] + uphill_x * planned_x[1] + uphill_y * planned_y[1],
        heave[2],
    )
    _project(
        axes,
        first,
        jacobian,
        (
            _commanded(proportional, derivative, planned_x, measured, 0),
            _commanded(proportional, derivative, planned_y, measured, 1),
            _commanded(proportional, derivative, planned_z, measured, 2),
        ),
        rows,
    )


def follow_base_over_ground(
    gains: FramedGains, kinematics: Kinematics, reference: ControlReference, first: int, rows: TaskRows
) -> None:
    """Write what the base origin shall do along the axes of the control frame from number ``first`` on to ``rows``."""
    write_motion_over_ground(
        (gains.proportional_per_s2, gains.derivative_per_s),
        reference.ground_axes,
        first,
        (reference.base_acceleration, reference.base_velocity, reference.base_position),
        (reference.base_acceleration[2], reference.base_velocity[2], reference.base_height),
        (kinematics.base_bias, kinematics.base_linear_velocity, kinematics.base_position),
        kinematics.base_jacobian,
        (rows.matrix, rows.upper),
    )
