"""The shape of the ground: an infinite floor and solid boxes."""

import math
from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array

_GROUND_LENGTH = 40.0  # [m]
_GROUND_WIDTH = 40.0  # [m]


@dataclass(frozen=True)
class TerrainBox:
    """A solid box of the terrain.

    Attributes:
        name: unique within the terrain.
        center: in world axes, (3,) in [m].
        half_size: half edge lengths, (3,) in [m].
        quat_wxyz: box to world, (4,).
    """

    name: str
    center: Array
    half_size: Array
    quat_wxyz: Array


@dataclass(frozen=True)
class Ground:
    """The whole terrain: an infinite floor and boxes.

    Attributes:
        floor_height: z of the infinite floor in [m]; below zero where terrain descends from the start.
        boxes: solid boxes.
    """

    floor_height: float
    boxes: tuple[TerrainBox, ...]


def yaw_quat(yaw: float) -> Array:
    """Return the quaternion wxyz, (4,), of a turn by ``yaw`` in [rad] about z."""
    return np.array([math.cos(0.5 * yaw), 0.0, 0.0, math.sin(0.5 * yaw)])


def ground_until(name: str, edge: float, floor_height: float) -> TerrainBox:
    """Return raised ground from far behind to x = ``edge``, from z = 0 down to the floor."""
    center = np.array([edge - 0.5 * _GROUND_LENGTH, 0.0, 0.5 * floor_height])
    return TerrainBox(name, center, 0.5 * np.array([_GROUND_LENGTH, _GROUND_WIDTH, -floor_height]), yaw_quat(0.0))


def ground_from(name: str, edge: float, height: float, width: float = _GROUND_WIDTH) -> TerrainBox:
    """Return raised ground from x = ``edge`` onwards, from ``height`` down to z = 0."""
    center = np.array([edge + 0.5 * _GROUND_LENGTH, 0.0, 0.5 * height])
    return TerrainBox(name, center, 0.5 * np.array([_GROUND_LENGTH, width, height]), yaw_quat(0.0))
