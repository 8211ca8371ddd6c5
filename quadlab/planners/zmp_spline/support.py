"""Support polygons as half-planes, and what is left of them inside a margin."""

from dataclasses import dataclass

import numpy as np

from quadlab.geometry.polygons import convex_hull
from quadlab.geometry.rotations import Array


@dataclass(frozen=True)
class SupportPolygon:
    """The points u with normals u <= offsets: a convex hull, every edge moved inwards.

    Attributes:
        normals: outward unit normals of the edges, (e, 2); the two sides and ends of a line if the hull is one.
        offsets: (e,) in [m].
        corners: counter-clockwise, (k, 2) in [m]; none if nothing is left inside the margin.
        middle: mean of the corners, of those of the hull itself if nothing is left inside the margin, (2,) in [m].
    """

    normals: Array
    offsets: Array
    corners: Array
    middle: Array

    @property
    def is_empty(self) -> bool:
        """Whether no point is inside."""
        return len(self.corners) == 0


def support_polygon(points: Array, margin: float) -> SupportPolygon:
    """Return the hull of ``points`` (n, 2) in [m], n >= 1, with every edge moved inwards by ``margin`` in [m]."""
    hull = convex_hull(points)
    starts, edges = _edges(hull)
    normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1) / np.linalg.norm(edges, axis=1)[:, None]
    offsets = (normals * starts).sum(axis=1) - margin
    corners = hull
    for normal, offset in zip(normals, offsets, strict=True):
        corners = _clipped(corners, normal, float(offset))
    return SupportPolygon(normals, offsets, corners, (corners if len(corners) else hull).mean(axis=0))


def _edges(hull: Array) -> tuple[Array, Array]:
    """Return start and direction of each edge, both (e, 2); a line and a point are boxes without width."""
    if len(hull) >= 3:
        return hull, np.roll(hull, -1, axis=0) - hull
    along = hull[-1] - hull[0] if len(hull) == 2 else np.array([1.0, 0.0])
    across = np.array([-along[1], along[0]])
    starts = np.stack([hull[0], hull[-1], hull[-1], hull[0]])
    return starts, np.stack([along, across, -along, -across])


def _clipped(corners: Array, normal: Array, offset: float) -> Array:
    """Return the part of a convex polygon where ``normal`` u <= ``offset`` (Sutherland and Hodgman 1974)."""
    kept: list[Array] = []
    heights = corners @ normal - offset
    for i, corner in enumerate(corners):
        before, height_before = corners[i - 1], heights[i - 1]
        if (height_before > _ON_EDGE) != (heights[i] > _ON_EDGE):
            kept.append(before + height_before / (height_before - heights[i]) * (corner - before))
        if heights[i] <= _ON_EDGE:
            kept.append(corner)
    return np.array(kept).reshape(-1, 2)


_ON_EDGE = 1e-12  # [m]
