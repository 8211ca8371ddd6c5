"""Convex hulls and distances against brute force and an independent implementation."""

import math

import numpy as np
import pytest
from scipy.optimize import lsq_linear
from scipy.spatial import ConvexHull

from quadlab.geometry.polygons import convex_hull, distance_inside, distances_outside
from quadlab.geometry.rotations import Array

TRIANGLE = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])


def signed_area(corners: Array) -> float:
    x, y = corners.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def brute_force_distance(point: Array, corners: Array) -> float:
    """Distance to the nearest convex combination, with the sum of the weights as a heavily weighed row."""
    weight = 1e4
    matrix = np.vstack([corners.T, np.full(len(corners), weight)])
    solution = lsq_linear(matrix, np.array([*point, weight]), bounds=(0.0, np.inf), method="bvls", tol=1e-14)
    weights = solution.x / solution.x.sum()
    return float(np.linalg.norm(weights @ corners - point))


@pytest.mark.parametrize("count", [3, 4, 5, 8, 20])
@pytest.mark.parametrize("seed", range(4))
def test_hull_is_that_of_an_independent_implementation(count: int, seed: int) -> None:
    points = np.random.default_rng(seed).normal(size=(count, 2))
    hull, reference = convex_hull(points), ConvexHull(points)
    assert signed_area(hull) == pytest.approx(reference.volume), "counter-clockwise: the area is positive"
    expected = {tuple(corner) for corner in points[reference.vertices]}
    assert {tuple(corner) for corner in hull} == expected
    assert len(hull) == len(expected)


def test_points_inside_repeated_or_on_an_edge_are_no_corners() -> None:
    points = np.vstack([TRIANGLE, TRIANGLE[0], [0.5, 0.5], [0.5, 0.0], [0.2, 0.2]])
    assert {tuple(corner) for corner in convex_hull(points)} == {tuple(corner) for corner in TRIANGLE}


@pytest.mark.parametrize(
    ("points", "count"),
    [([[1.0, 2.0]], 1), ([[1.0, 2.0], [1.0, 2.0]], 1), ([[0, 0], [1, 1]], 2), ([[0, 0], [1, 1], [3, 3], [2, 2]], 2)],
)
def test_hull_of_a_point_or_a_line_is_its_ends(points: list[list[float]], count: int) -> None:
    hull = convex_hull(np.array(points, float))
    assert len(hull) == count
    np.testing.assert_array_equal(hull[0], np.min(points, axis=0))
    np.testing.assert_array_equal(hull[-1], np.max(points, axis=0))


@pytest.mark.parametrize("count", [1, 2, 3, 4, 6])
@pytest.mark.parametrize("seed", range(6))
def test_distance_is_that_to_the_nearest_convex_combination(count: int, seed: int) -> None:
    generator = np.random.default_rng(seed)
    corners = generator.normal(size=(count, 2))
    points = 1.5 * generator.normal(size=(8, 2))
    expected = [brute_force_distance(point, corners) for point in points]
    assert distances_outside(points, corners) == pytest.approx(expected, abs=1e-5)


def test_every_convex_combination_is_inside() -> None:
    generator = np.random.default_rng(3)
    corners = generator.normal(size=(5, 2))
    weights = generator.dirichlet(np.ones(5), 50)
    assert np.all(distances_outside(weights @ corners, corners) == 0.0)


@pytest.mark.parametrize(
    ("point", "distance"),
    [([0.2, 0.2], 0.0), ([0.0, 0.0], 0.0), ([-0.3, 0.5], 0.3), ([1.0, 1.0], math.sqrt(0.5)), ([4.0, -4.0], 5.0)],
)
def test_distances_to_a_triangle(point: list[float], distance: float) -> None:
    assert distances_outside(np.array([point]), TRIANGLE)[0] == pytest.approx(distance)


@pytest.mark.parametrize(("point", "distance"), [([0.5, 0.0], 0.0), ([0.5, 0.2], 0.2), ([4.0, 4.0], 5.0)])
def test_two_feet_support_a_segment(point: list[float], distance: float) -> None:
    assert distances_outside(np.array([point]), TRIANGLE[:2])[0] == pytest.approx(distance)


@pytest.mark.parametrize("seed", range(4))
def test_distance_inside_is_that_to_the_nearest_edge(seed: int) -> None:
    generator = np.random.default_rng(seed)
    corners = generator.normal(size=(5, 2))
    equations = ConvexHull(corners).equations
    for point in generator.normal(size=(50, 2)):
        expected = max(0.0, -float(np.max(equations[:, :2] @ point + equations[:, 2])))
        assert distance_inside(point, corners) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("count", [1, 2])
def test_nothing_is_inside_a_point_or_a_segment(count: int) -> None:
    assert distance_inside(TRIANGLE[:count].mean(axis=0), TRIANGLE[:count]) == 0.0
