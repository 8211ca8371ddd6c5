"""Planar convex hulls, for support polygons of one, two or more points."""

import numpy as np

from quadlab.geometry.rotations import Array


def convex_hull(points: Array) -> Array:
    """Return the corners of the convex hull of (n, 2) points, counter-clockwise, (m, 2), m <= n."""
    unique = np.unique(np.asarray(points, float), axis=0)
    if len(unique) <= 2:
        return unique

    def half(ordered: Array) -> list[Array]:
        chain: list[Array] = []
        for point in ordered:
            while len(chain) >= 2 and _turn(chain[-2], chain[-1], point) <= 0.0:
                chain.pop()
            chain.append(point)
        return chain[:-1]

    return np.array(half(unique) + half(unique[::-1]))


def distances_outside(points: Array, corners: Array) -> Array:
    """Return how far each of ``points`` (s, 2) lies outside the hull of ``corners`` (n, 2), (s,) in [m]; 0 inside.

    A hull of one or two points is a point or a segment; nothing lies inside it but itself.
    """
    hull = convex_hull(corners)
    edges = np.roll(hull, -1, axis=0) - hull
    relative = points[:, None, :] - hull[None]
    length_squared = np.maximum((edges**2).sum(axis=1), 1e-300)
    share = np.clip((relative * edges).sum(axis=2) / length_squared, 0.0, 1.0)
    distance: Array = np.linalg.norm(relative - share[:, :, None] * edges, axis=2).min(axis=1)
    turn = edges[:, 0] * relative[:, :, 1] - edges[:, 1] * relative[:, :, 0]
    inside = (turn >= 0.0).all(axis=1) & (len(hull) >= 3)
    return np.where(inside, 0.0, distance)


def distance_inside(point: Array, corners: Array) -> float:
    """Return how far ``point`` (2,) is from the border of the hull of ``corners`` (n, 2) in [m]; 0 outside.

    A hull of one or two points has no inside.
    """
    hull = convex_hull(corners)
    if len(hull) <= 2 or not _is_inside(point, hull):
        return 0.0
    return min(_distance_to_segment(point, hull[i - 1], hull[i]) for i in range(len(hull)))


def _turn(a: Array, b: Array, c: Array) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _is_inside(point: Array, hull: Array) -> bool:
    return all(_turn(hull[i - 1], hull[i], point) >= 0.0 for i in range(len(hull)))


def _distance_to_segment(point: Array, a: Array, b: Array) -> float:
    along = b - a
    share = float(np.clip((point - a) @ along / max(float(along @ along), 1e-300), 0.0, 1.0))
    return float(np.hypot(*(point - a - share * along)))
