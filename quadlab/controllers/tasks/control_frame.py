"""Rows of motion tasks in the control frame, which leans with the ground (Gehring 2017, III-C; Bellicoso 2016, IV-A).

Its axes are heading, lateral and normal of the ground. A plan is made for level ground and is laid on the ground that
there is: planned positions move, and planned linear velocities and accelerations point, parallel to it.

Deviations from Bellicoso 2016:

- Errors are written in the axes of this tick, and how fast these turn is left out.
- The heading is that of the aligned plan, where the paper takes that of the body.
- Heights are vertical, over the ground under the robot. A torso that limb limits keep from its height would be pushed
  to the side by rows along the heading that know of the height, and would tilt for the sake of a row along the normal:
  the base origin is not the CoM, so that turning moves it along the ground. On a step of 14 cm the robot then falls.
"""

from enum import StrEnum

from quadlab.controllers.tasks.gains import TrackingGains, write_tracking_rows
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled, compiled_entry


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


def write_horizontal_rows(
    gains: FramedGains,
    ground_axes: Array,
    planned: tuple[Array, Array, Array],
    measured: tuple[Array, Array, Array],
    jacobian: Array,
    rows: tuple[Array, Array],
) -> None:
    """Write the two rows that follow a planned motion, along x and y or along heading and lateral of the ground.

    Arguments as of ``write_motion_over_ground``.
    """
    proportional, derivative = gains.proportional_per_s2, gains.derivative_per_s
    if gains.frame is Frame.CONTROL:
        write_motion_over_ground((proportional, derivative), ground_axes, planned, measured, jacobian, rows)
        return
    velocities, positions = (planned[1], measured[1]), (planned[2], measured[2])
    write_tracking_rows(proportional, derivative, planned[0], velocities, positions, measured[0], jacobian, rows)


@compiled
def _along(axes: Array, axis: int, jacobian: Array, row: Array) -> None:
    """Write what ``jacobian``, (3, n) or more rows, has along one of ``axes``, columns of (3, 3), to ``row``, (n,)."""
    x, y, z = axes[0, axis], axes[1, axis], axes[2, axis]
    for column in range(len(row)):
        row[column] = x * jacobian[0, column] + y * jacobian[1, column] + z * jacobian[2, column]


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
    matrix, turned = rows
    for row in range(len(matrix)):
        axis = first + row
        _along(axes, axis, jacobian, matrix[row])
        turned[row] = axes[0, axis] * target[0] + axes[1, axis] * target[1] + axes[2, axis] * target[2]


@compiled_entry
def write_motion_over_ground(
    gains: tuple[float, float],
    axes: Array,
    planned: tuple[Array, Array, Array],
    measured: tuple[Array, Array, Array],
    jacobian: Array,
    rows: tuple[Array, Array],
) -> None:
    """Write the two rows that follow a planned motion along heading and lateral of the ground.

    What is commanded over the level ground of the plan, x and y, is commanded along the ground: (x, y, slope (x, y)).

    Args:
        gains: proportional in [1/s^2] and derivative in [1/s].
        axes: columns heading, lateral and normal in world components, (3, 3).
        planned: acceleration, velocity and position as seen from above, x and y first, (2,) or more.
        measured: J_dot u, velocity and position in world axes, (3,) each.
        jacobian: J of the point in world axes, (3, n) or more rows.
        rows: matrix (2, n) and right-hand side (2,) to write to.
    """
    matrix, target = rows
    proportional, derivative = gains
    x = planned[0][0] + derivative * (planned[1][0] - measured[1][0]) + proportional * (planned[2][0] - measured[2][0])
    y = planned[0][1] + derivative * (planned[1][1] - measured[1][1]) + proportional * (planned[2][1] - measured[2][1])
    z = -(axes[0, 2] * x + axes[1, 2] * y) / axes[2, 2]
    bias = measured[0]
    for axis in range(2):
        _along(axes, axis, jacobian, matrix[axis])
        target[axis] = axes[0, axis] * (x - bias[0]) + axes[1, axis] * (y - bias[1]) + axes[2, axis] * (z - bias[2])


def climbing_speed(axes: Array, velocity: Array) -> float:
    """Return how fast the ground under a point rises that moves with ``velocity``, (3,) in [m/s], in [m/s].

    Args:
        axes: columns heading, lateral and normal in world components, (3, 3).
        velocity: in world components.
    """
    normal = axes[:, 2]
    return float(-(normal[0] * velocity[0] + normal[1] * velocity[1]) / normal[2])
