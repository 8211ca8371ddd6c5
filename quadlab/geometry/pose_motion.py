"""A pose curve at one time, compiled; apart from the curve, since loading numba takes longer than drawing most figures.

Quaternions are tuples w, x, y, z and vectors tuples x, y, z.
"""

import math

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.jit import compiled, compiled_entry

Quat = tuple[float, float, float, float]
Vector = tuple[float, float, float]


@compiled_entry
def pose_motion(
    knots: Array, durations: Array, coefficients: Array, quats: Array, turns: Array, time_s: float
) -> Array:
    """Return the motion of a ``PoseCurve``, whose attributes the arguments are.

    Returns:
        position, velocity, acceleration, three rows of the rotation, angular velocity, angular acceleration, (8, 3).
    """
    inside = min(max(time_s, knots[0]), knots[-1])
    piece = np.searchsorted(knots[1:-1], inside, side="right")
    local = inside - knots[piece]
    motion = np.zeros((8, 3))
    _write_position(coefficients[piece], local, motion)
    _write_orientation(quats[piece], turns[piece], local / durations[piece], 1.0 / durations[piece], motion)
    if inside != time_s:
        motion[1:3] = 0.0
        motion[6:8] = 0.0
    return motion


@compiled
def _write_position(coefficients: Array, local: float, motion: Array) -> None:
    """Write a cubic, (4, 3) ascending powers, and two derivatives at the ``local`` time in [s] to the rows 0 to 2."""
    for axis in range(3):
        c0, c1, c2, c3 = coefficients[:, axis]
        motion[0, axis] = c0 + local * (c1 + local * (c2 + local * c3))
        motion[1, axis] = c1 + local * (2.0 * c2 + local * 3.0 * c3)
        motion[2, axis] = 2.0 * c2 + local * 6.0 * c3


@compiled
def _write_orientation(start: Array, turns: Array, phase: float, rate: float, motion: Array) -> None:
    """Write q = q0 E_1 E_2 E_3 with E_i = exp(w_i b_i) and its derivatives to the rows 3 to 7.

    With each factor the angular velocity v and acceleration a in the axes of the body become

        v <- E^-1 v E + w b_dot,    a <- E^-1 a E + (E^-1 v E) x (w b_dot) + w b_ddot

    Args:
        start: q0, (4,).
        turns: w_1 to w_3, (3, 3) in [rad].
        phase: share u of the piece that is over, 0 to 1.
        rate: du/dt in [1/s].
        motion: to write to.
    """
    quat = (start[0], start[1], start[2], start[3])
    velocity, acceleration = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for i in range(3):
        turn = (turns[i, 0], turns[i, 1], turns[i, 2])
        basis, basis_dot, basis_ddot = _cumulative_basis(i, phase, rate)
        factor = _exponential(_scaled(basis, turn))
        step = _scaled(basis_dot, turn)
        quat = _product(quat, factor)
        velocity, acceleration = _turned_back(factor, velocity), _turned_back(factor, acceleration)
        acceleration = _sum(acceleration, _sum(_cross(velocity, step), _scaled(basis_ddot, turn)))
        velocity = _sum(velocity, step)
    _write_in_plan_axes(quat, velocity, acceleration, motion)


@compiled
def _write_in_plan_axes(quat: Quat, velocity: Vector, acceleration: Vector, motion: Array) -> None:
    """Write the rotation R to the rows 3 to 5, R v and R a to the rows 6 and 7; v x v = 0 spares the third term."""
    back = (quat[0], -quat[1], -quat[2], -quat[3])
    columns = (
        _turned_back(back, (1.0, 0.0, 0.0)),
        _turned_back(back, (0.0, 1.0, 0.0)),
        _turned_back(back, (0.0, 0.0, 1.0)),
    )
    velocity, acceleration = _turned_back(back, velocity), _turned_back(back, acceleration)
    for i in range(3):
        for j in range(3):
            motion[3 + i, j] = columns[j][i]
        motion[6, i] = velocity[i]
        motion[7, i] = acceleration[i]


@compiled
def _cumulative_basis(index: int, u: float, rate: float) -> Vector:
    """Return the cumulative Bernstein polynomial of degree 3 number ``index`` + 1 and two time derivatives.

    These are 1 - (1 - u)^3, 3 u^2 - 2 u^3 and u^3.
    """
    left = 1.0 - u
    if index == 0:
        return 1.0 - left * left * left, 3.0 * left * left * rate, -6.0 * left * rate * rate
    if index == 1:
        return u * u * (3.0 - 2.0 * u), 6.0 * u * left * rate, (6.0 - 12.0 * u) * rate * rate
    return u * u * u, 3.0 * u * u * rate, 6.0 * u * rate * rate


@compiled
def _exponential(vector: Vector) -> Quat:
    """Return the unit quaternion that turns by the rotation vector in [rad]."""
    half = 0.5 * math.sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2])
    scale = 0.5 * math.sin(half) / half if half > 1e-12 else 0.5
    return math.cos(half), scale * vector[0], scale * vector[1], scale * vector[2]


@compiled
def _product(p: Quat, q: Quat) -> Quat:
    """Return the Hamilton product p q."""
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )


@compiled
def _turned_back(quat: Quat, vector: Vector) -> Vector:
    """Return q^-1 v q = v + 2 w (v x r) + 2 (v x r) x r of a unit quaternion with the parts w and r."""
    part = (quat[1], quat[2], quat[3])
    once = _cross(vector, part)
    return _sum(vector, _sum(_scaled(2.0 * quat[0], once), _scaled(2.0, _cross(once, part))))


@compiled
def _cross(a: Vector, b: Vector) -> Vector:
    """Return a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@compiled
def _scaled(factor: float, a: Vector) -> Vector:
    """Return factor a."""
    return factor * a[0], factor * a[1], factor * a[2]


@compiled
def _sum(a: Vector, b: Vector) -> Vector:
    """Return a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]
