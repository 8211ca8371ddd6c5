"""The local ground as a plane through the most recent stance feet (Gehring 2017, III-A; Bellicoso 2016, IV)."""

import math
from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry


@dataclass(frozen=True)
class TerrainPlane:
    """The plane z = height + slope . (xy - origin), in world components.

    Attributes:
        origin: where ``height`` holds, (2,) in [m].
        height: in [m].
        slope: (dz/dx, dz/dy), (2,).
    """

    origin: Array
    height: float
    slope: Array

    def height_at(self, position_xy: Array) -> float:
        """Return the height of the plane in [m] at ``position_xy``, (2,) in [m]."""
        (slope_x, slope_y), (x, y), (x_0, y_0) = self.slope.tolist(), position_xy.tolist(), self.origin.tolist()
        height: float = self.height + slope_x * (x - x_0) + slope_y * (y - y_0)
        return height

    def moved_to(self, origin: Array) -> "TerrainPlane":
        """Return the same plane written about another origin, (2,) in [m]."""
        return TerrainPlane(origin, self.height_at(origin), self.slope)

    @property
    def normal(self) -> Array:
        """Unit normal, pointing up, (3,)."""
        slope_x, slope_y = self.slope.tolist()
        length = math.sqrt(1.0 + slope_x**2 + slope_y**2)
        return np.array([-slope_x / length, -slope_y / length, 1.0 / length])


def fit_plane(points: Array, origin: Array) -> TerrainPlane:
    """Return the least-squares plane through ``points``, (n, 3) in [m], written about ``origin``, (2,).

    The points must not lie on one vertical plane; four feet never do.
    """
    height, slope = _least_squares_plane(points, origin)
    return TerrainPlane(origin, height, slope)


@compiled_entry
def _least_squares_plane(points: Array, origin: Array) -> tuple[float, Array]:
    """Return height at ``origin`` and slope, (2,): about the mean of the points the normal equations are two."""
    count = len(points)
    x, y, z = points[:, 0].sum() / count, points[:, 1].sum() / count, points[:, 2].sum() / count
    xx, xy, yy, xz, yz = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(count):
        dx, dy, dz = points[i, 0] - x, points[i, 1] - y, points[i, 2] - z
        xx, xy, yy = xx + dx * dx, xy + dx * dy, yy + dy * dy
        xz, yz = xz + dx * dz, yz + dy * dz
    determinant = xx * yy - xy * xy
    slope = np.array([(yy * xz - xy * yz) / determinant, (xx * yz - xy * xz) / determinant])
    return z + slope[0] * (origin[0] - x) + slope[1] * (origin[1] - y), slope


def blend(old: TerrainPlane, new: TerrainPlane, share: float) -> TerrainPlane:
    """Return ``old`` moved towards ``new`` by ``share`` in [0, 1], written about the origin of ``new``."""
    same_place = old.moved_to(new.origin)
    return TerrainPlane(
        new.origin,
        same_place.height + share * (new.height - same_place.height),
        same_place.slope + share * (new.slope - same_place.slope),
    )
