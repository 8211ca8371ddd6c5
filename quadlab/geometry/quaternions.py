"""Products, exponentials and logarithms of many quaternions at once; all are wxyz."""

import numpy as np

from quadlab.geometry.rotations import Array


def quat_product(left: Array, right: Array) -> Array:
    """Return the Hamilton products left right, both (n, 4); (n, 4)."""
    scalar = left[:, :1] * right[:, :1] - np.sum(left[:, 1:] * right[:, 1:], axis=1, keepdims=True)
    vector = left[:, :1] * right[:, 1:] + right[:, :1] * left[:, 1:] + np.cross(left[:, 1:], right[:, 1:])
    return np.hstack([scalar, vector])


def quat_inverse(quats: Array) -> Array:
    """Return the inverses of unit quaternions, (n, 4)."""
    inverses: Array = quats * np.array([1.0, -1.0, -1.0, -1.0])
    return inverses


def quat_exp(vectors: Array) -> Array:
    """Return the unit quaternions, (n, 4), that turn by the rotation vectors, (n, 3) in [rad]."""
    half_angles = 0.5 * np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.hstack([np.cos(half_angles), 0.5 * np.sinc(half_angles / np.pi) * vectors])


def quat_log(quats: Array) -> Array:
    """Return the rotation vectors, (n, 3) in [rad], of unit quaternions, (n, 4).

    The sign of a quaternion counts: it is the turn from the quaternion 1, along the shortest arc on the sphere of
    quaternions, which takes up to a full turn.
    """
    sines = np.linalg.norm(quats[:, 1:], axis=1, keepdims=True)
    angles = 2.0 * np.arctan2(sines, quats[:, :1])
    small = sines < 1e-12
    vectors: Array = np.where(small, 2.0, angles / np.where(small, 1.0, sines)) * quats[:, 1:]
    return vectors
