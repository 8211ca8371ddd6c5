"""Random hierarchies with everything that makes them hard: dependent, duplicate, zero and infeasible rows."""

import numpy as np

from quadlab.controllers.hierarchy.level import Level
from quadlab.geometry.rotations import Array

DIMENSION = 12
MAX_LEVELS = 11


def random_hierarchy(seed: int, dimension: int = DIMENSION, max_levels: int = MAX_LEVELS) -> list[Level]:
    """Return a hierarchy of 1 to ``max_levels`` levels in ``dimension`` unknowns, reproducible from ``seed``."""
    rng = np.random.default_rng(seed)
    origin = rng.normal(size=dimension) * rng.choice([0.0, 1.0, 10.0])
    levels: list[Level] = []
    for index in range(int(rng.integers(1, max_levels + 1))):
        earlier = np.vstack([np.zeros((0, dimension)), *(level.matrix for level in levels)])
        matrix = _random_rows(rng, dimension, earlier)
        lower, upper = _random_bounds(rng, matrix @ origin)
        levels.append(Level(f"level {index}", matrix, lower, upper))
    return levels


def _random_rows(rng: np.random.Generator, dimension: int, earlier: Array) -> Array:
    kind = rng.choice(["dense", "box", "sparse", "low rank", "repeated", "empty"], p=[0.3, 0.15, 0.2, 0.15, 0.1, 0.1])
    count = int(rng.integers(1, 9))
    matrix: Array
    if kind == "empty":
        return np.zeros((0, dimension))
    if kind == "box":
        return np.eye(dimension)
    if kind == "low rank":
        rank = int(rng.integers(1, 3))
        matrix = rng.normal(size=(count, rank)) @ rng.normal(size=(rank, dimension))
    elif kind == "sparse":
        matrix = rng.integers(-1, 2, size=(count, dimension)).astype(np.float64) * (
            rng.random((count, dimension)) < 0.3
        )
    elif kind == "repeated" and len(earlier):
        matrix = earlier[rng.integers(0, len(earlier), size=count)] * rng.choice([-1.0, 1.0, 2.0], size=(count, 1))
    else:
        matrix = rng.normal(size=(count, dimension))
    if rng.random() < 0.2:
        matrix = np.vstack([matrix, matrix[:1], -matrix[:1], np.zeros((1, dimension))])
    return matrix


def _random_bounds(rng: np.random.Generator, values: Array) -> tuple[Array, Array]:
    """Return bounds around ``values``: met exactly, met with room, degenerate, or far away."""
    count = len(values)
    centre = values + rng.normal(size=count) * rng.choice([0.0, 0.5, 3.0])
    width = rng.choice([0.0, 0.3, 1.0], size=count) * rng.random(count)
    half = np.where(rng.random(count) < rng.choice([0.0, 0.5, 1.0]), 0.0, width + 0.05)
    if rng.random() < 0.3:  # integers meet in degenerate corners
        centre, half = np.round(centre), np.ceil(half)
    lower, upper = centre - half, centre + half
    side = rng.random(count)
    inequality = half > 0.0
    lower[inequality & (side < 0.3)] = -np.inf
    upper[inequality & (side > 0.7)] = np.inf
    return lower, upper
