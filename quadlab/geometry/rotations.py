"""Rotations: quaternions are wxyz and turn body components into world components."""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def wrap_angle(angle: float) -> float:
    """Return ``angle`` in [rad] moved into [-pi, pi)."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def rotation_2d(angle: float) -> Array:
    """Return the (2, 2) rotation by ``angle`` in [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


def rotation_z(angle: float) -> Array:
    """Return the (3, 3) rotation about z by ``angle`` in [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def rotation_zyx(yaw: float, pitch: float, roll: float) -> Array:
    """Return Rz(yaw) Ry(pitch) Rx(roll), angles in [rad], (3, 3)."""
    cy, sy = math.cos(yaw), math.sin(yaw)
    cp, sp = math.cos(pitch), math.sin(pitch)
    cr, sr = math.cos(roll), math.sin(roll)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def euler_zyx(rotation: Array) -> tuple[float, float, float]:
    """Return (yaw, pitch, roll) in [rad] of a (3, 3) rotation Rz(yaw) Ry(pitch) Rx(roll)."""
    yaw = math.atan2(rotation[1, 0], rotation[0, 0])
    pitch = math.asin(min(1.0, max(-1.0, -float(rotation[2, 0]))))
    roll = math.atan2(rotation[2, 1], rotation[2, 2])
    return yaw, pitch, roll


def yaw_of(rotation: Array) -> float:
    """Return the heading in [rad] of a (3, 3) rotation: direction of its x axis on the ground."""
    return math.atan2(rotation[1, 0], rotation[0, 0])


def tilt_of(rotation: Array) -> float:
    """Return the angle in [rad] between the rotated z axis and the vertical."""
    return math.acos(min(1.0, max(-1.0, float(rotation[2, 2]))))


def quat_to_matrix(quat_wxyz: Array) -> Array:
    """Return the (3, 3) rotation of a unit quaternion, (4,) wxyz."""
    w, x, y, z = np.asarray(quat_wxyz, dtype=np.float64).tolist()
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def matrix_to_quat(rotation: Array) -> Array:
    """Return the unit quaternion, (4,) wxyz with w >= 0, of a (3, 3) rotation."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rotation.tolist()
    squares = (1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz)
    w_x, w_y, w_z = zy - yz, xz - zx, yx - xy
    x_y, x_z, y_z = xy + yx, xz + zx, yz + zy
    rows = (
        (squares[0], w_x, w_y, w_z),
        (w_x, squares[1], x_y, x_z),
        (w_y, x_y, squares[2], y_z),
        (w_z, x_z, y_z, squares[3]),
    )
    quat = rows[squares.index(max(squares))]
    norm = math.copysign(math.hypot(*quat), quat[0])
    return np.array([part / norm for part in quat])


def rotation_log(rotation: Array) -> Array:
    """Return the rotation vector, (3,) in [rad], of a (3, 3) rotation (exact near 0 and near pi)."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rotation.tolist()
    x, y, z = zy - yz, xz - zx, yx - xy
    sine = 0.5 * math.sqrt(x * x + y * y + z * z)
    cosine = 0.5 * (xx + yy + zz - 1.0)
    if cosine < 0.0 and sine < 1e-3:
        return _log_near_half_turn(rotation)
    scale = 0.5 * math.atan2(sine, cosine) / sine if sine > 1e-12 else 0.5
    return np.array([scale * x, scale * y, scale * z])


def _log_near_half_turn(rotation: Array) -> Array:
    """Where the antisymmetric part vanishes the quaternion still knows the axis."""
    quat = matrix_to_quat(rotation)
    sine = math.sqrt(float(quat[1] ** 2 + quat[2] ** 2 + quat[3] ** 2))
    vector: Array = (2.0 * math.atan2(sine, float(quat[0])) / sine) * quat[1:]
    return vector


def skew(vector: Array) -> Array:
    """Return the (3, 3) matrix S with S b = vector x b."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
