"""Attitude of torso and ground: the control frame of Gehring 2017 and Bellicoso 2016."""

import math

import numpy as np

from quadlab.estimation.terrain_plane import TerrainPlane
from quadlab.geometry.rotations import Array, rotation_zyx


def torso_rotation(yaw: float, terrain: TerrainPlane, slope_following: float) -> Array:
    """Return the desired base rotation, (3, 3): heading ``yaw`` in [rad], roll and pitch a share of the slope.

    Roll and pitch are those of slopes in one direction; across both at once the base leans by a higher order more.
    """
    c, s = math.cos(yaw), math.sin(yaw)
    slope_x, slope_y = terrain.slope
    forward, left = c * slope_x + s * slope_y, -s * slope_x + c * slope_y
    return rotation_zyx(yaw, -math.atan(slope_following * forward), math.atan(slope_following * left))


def ground_axes(yaw: float, terrain: TerrainPlane) -> Array:
    """Return the columns heading, lateral and normal of the ground, (3, 3), for a heading ``yaw`` in [rad]."""
    c, s = math.cos(yaw), math.sin(yaw)
    nx, ny, nz = terrain.normal.tolist()
    off_plane = c * nx + s * ny
    hx, hy, hz = c - off_plane * nx, s - off_plane * ny, -off_plane * nz
    length = math.sqrt(hx * hx + hy * hy + hz * hz)
    hx, hy, hz = hx / length, hy / length, hz / length
    lateral = (ny * hz - nz * hy, nz * hx - nx * hz, nx * hy - ny * hx)
    return np.array([(hx, hy, hz), lateral, (nx, ny, nz)]).T
