"""Arrows and lines that are no part of the simulated world."""

from itertools import pairwise
from typing import Any

import mujoco
import numpy as np

from quadlab.geometry.rotations import Array

PUSH_RGBA = (0.85, 0.15, 0.12, 1.0)
FORCE_RGBA = (0.12, 0.47, 0.71, 0.85)
REFERENCE_RGBA = (0.95, 0.55, 0.10, 0.9)
SHORTEST_M = 1e-6
"""Shorter arrows, and those with an end that is not finite, are left out."""

LONGEST_LINE = 250
"""Segments of a line; a longer one is thinned out."""


def add_arrow(scene: Any, tail: Array, tip: Array, width: float, rgba: tuple[float, float, float, float]) -> None:
    """Add an arrow between two points, (3,) in [m], to ``scene``, an ``MjvScene``.

    Args:
        scene: a full scene stays as it is.
        tail: start in world.
        tip: end in world.
        width: radius of the shaft in [m].
        rgba: colour.
    """
    _add_connector(scene, mujoco.mjtGeom.mjGEOM_ARROW, tail, tip, width, rgba)


def add_line(scene: Any, points: Array, width_pixels: float, rgba: tuple[float, float, float, float]) -> None:
    """Add a line of ``width_pixels`` through (n, 3) points in [m]."""
    kept = points[np.unique(np.linspace(0, len(points) - 1, min(len(points), LONGEST_LINE + 1)).astype(int))]
    for start, end in pairwise(kept):
        _add_connector(scene, mujoco.mjtGeom.mjGEOM_LINE, start, end, width_pixels, rgba)


def _add_connector(
    scene: Any, kind: Any, start: Array, end: Array, width: float, rgba: tuple[float, float, float, float]
) -> None:
    length = float(np.linalg.norm(end - start))
    if scene.ngeom >= scene.maxgeom or not SHORTEST_M < length < np.inf:
        return
    geom = scene.geoms[scene.ngeom]
    color = np.array(rgba, np.float32)
    mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.eye(3).ravel(), color)
    mujoco.mjv_connector(geom, kind, width, start, end)
    geom.category = mujoco.mjtCatBit.mjCAT_DECOR
    scene.ngeom += 1
