"""The local ground as a plane through the most recent stance feet (Gehring 2017, III-A; Bellicoso 2016, IV)."""

import math
from typing import NamedTuple

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry

_LEAST_SPREAD = 1e-12
"""Of points across the line through them: the square of their width over their length; less is rounding."""


class TerrainPlane(NamedTuple):
    """The plane z = height + slope . (xy - origin), in world components and numbers of Python.

    Attributes:
        origin: where ``height`` holds, x and y in [m].
        height: in [m].
        slope: (dz/dx, dz/dy).
    """

    origin: tuple[float, float]
    height: float
    slope: tuple[float, float]

    def height_at(self, position_xy: Array) -> float:
        """Return the height of the plane in [m] at ``position_xy``, (2,) in [m]."""
        x, y = position_xy.tolist()
        return self._height_at(x, y)

    def moved_to(self, origin: tuple[float, float]) -> "TerrainPlane":
        """Return the same plane written about another origin, x and y in [m]."""
        return TerrainPlane(origin, self._height_at(*origin), self.slope)

    def _height_at(self, x: float, y: float) -> float:
        (slope_x, slope_y), (x_0, y_0) = self.slope, self.origin
        return self.height + slope_x * (x - x_0) + slope_y * (y - y_0)

    @property
    def normal(self) -> Array:
        """Unit normal, pointing up, (3,)."""
        slope_x, slope_y = self.slope
        length = math.sqrt(1.0 + slope_x**2 + slope_y**2)
        return np.array([-slope_x / length, -slope_y / length, 1.0 / length])


def fit_plane(points: Array, origin: Array) -> TerrainPlane:
    """Return the least-squares plane through ``points``, (n, 3) in [m], written about ``origin``, (2,).

    Points on one vertical plane, as under a robot that has fallen over, give NaN.
    """
    x, y = origin.tolist()
    height, slope_x, slope_y = _least_squares_plane(points, x, y)
    return TerrainPlane((x, y), height, (slope_x, slope_y))


@compiled_entry
def _least_squares_plane(points: Array, origin_x: float, origin_y: float) -> tuple[float, float, float]:
    """Return height at the origin and slope: about the mean of the points the normal equations are two."""
    count = len(points)
    x, y, z = points[:, 0].sum() / count, points[:, 1].sum() / count, points[:, 2].sum() / count
    xx, xy, yy, xz, yz = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(count):
        dx, dy, dz = points[i, 0] - x, points[i, 1] - y, points[i, 2] - z
        xx, xy, yy = xx + dx * dx, xy + dx * dy, yy + dy * dy
        xz, yz = xz + dx * dz, yz + dy * dz
    determinant = xx * yy - xy * xy
    if not determinant > _LEAST_SPREAD * (xx + yy) ** 2:
        return math.nan, math.nan, math.nan
    slope_x, slope_y = (yy * xz - xy * yz) / determinant, (xx * yz - xy * xz) / determinant
    return z + slope_x * (origin_x - x) + slope_y * (origin_y - y), slope_x, slope_y


def blend(old: TerrainPlane, new: TerrainPlane, share: float) -> TerrainPlane:
    """Return ``old`` moved towards ``new`` by ``share`` in [0, 1], written about the origin of ``new``.

    A new plane that is none, of points on one line, leaves the old one.
    """
    if not math.isfinite(new.height):
        return old.moved_to(new.origin)
    height = old.moved_to(new.origin).height
    (old_x, old_y), (new_x, new_y) = old.slope, new.slope
    slope = (old_x + share * (new_x - old_x), old_y + share * (new_y - old_y))
    return TerrainPlane(new.origin, height + share * (new.height - height), slope)
