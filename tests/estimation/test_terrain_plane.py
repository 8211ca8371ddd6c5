"""The plane through the feet: exact for points of a plane, the same plane wherever it is written about."""

import numpy as np
import pytest

from quadlab.estimation.terrain_plane import TerrainPlane, blend, fit_plane
from quadlab.geometry.rotations import Array

XY = np.array([[0.36, 0.20], [0.31, -0.22], [-0.35, 0.18], [-0.38, -0.2]])
ORIGIN = (0.05, -0.02)
PLANES = [(0.0, (0.0, 0.0)), (0.4, (0.3, -0.1)), (-1.0, (-0.5, 0.8))]
planes = pytest.mark.parametrize(("height", "slope"), PLANES)


def plane(height: float, slope: tuple[float, float], origin: tuple[float, float] = ORIGIN) -> TerrainPlane:
    return TerrainPlane(origin, height, slope)


def points_on(terrain: TerrainPlane, xy: Array) -> Array:
    return np.column_stack([xy, [terrain.height_at(point) for point in xy]])


@planes
@pytest.mark.parametrize("count", [3, 4])
def test_points_of_a_plane_give_that_plane(height: float, slope: tuple[float, float], count: int) -> None:
    fitted = fit_plane(points_on(plane(height, slope), XY[:count]), np.array(ORIGIN))
    assert fitted.height == pytest.approx(height, abs=1e-12)
    np.testing.assert_allclose(fitted.slope, slope, atol=1e-12)
    assert fitted.origin == ORIGIN


def test_errors_of_the_fit_balance() -> None:
    """Least squares: the residuals are orthogonal to every plane."""
    points = np.column_stack([XY, [0.0, 0.1, 0.05, -0.05]])
    fitted = fit_plane(points, np.array(ORIGIN))
    residuals = points[:, 2] - np.array([fitted.height_at(xy) for xy in XY])
    assert np.abs(residuals).max() > 0.01
    np.testing.assert_allclose(residuals @ np.column_stack([np.ones(4), XY]), 0.0, atol=1e-12)


@planes
def test_plane_is_the_same_wherever_it_is_written_about(height: float, slope: tuple[float, float]) -> None:
    terrain = plane(height, slope)
    moved = terrain.moved_to((2.0, -3.0))
    assert moved.origin == (2.0, -3.0)
    for xy in XY:
        assert moved.height_at(xy) == pytest.approx(terrain.height_at(xy))
    np.testing.assert_allclose(moved.normal, terrain.normal)


@planes
def test_normal_is_orthogonal_to_the_plane_and_points_up(height: float, slope: tuple[float, float]) -> None:
    terrain = plane(height, slope)
    assert np.linalg.norm(terrain.normal) == pytest.approx(1.0)
    assert terrain.normal[2] > 0.0
    corners = points_on(terrain, XY)
    np.testing.assert_allclose((corners[1:] - corners[0]) @ terrain.normal, 0.0, atol=1e-12)


@pytest.mark.parametrize(("share", "expected"), [(0.0, 0), (1.0, 1)])
def test_blend_ends_at_the_old_and_at_the_new_plane(share: float, expected: int) -> None:
    old, new = plane(0.1, (0.2, 0.0)), plane(-0.3, (0.0, 0.4), (1.0, 1.0))
    blended = blend(old, new, share)
    assert blended.origin == new.origin
    for xy in XY:
        assert blended.height_at(xy) == pytest.approx((old, new)[expected].height_at(xy))


def test_blend_lies_between_the_planes_everywhere() -> None:
    old, new = plane(0.1, (0.2, 0.0)), plane(-0.3, (0.0, 0.4), (1.0, 1.0))
    blended = blend(old, new, 0.3)
    for xy in XY:
        assert blended.height_at(xy) == pytest.approx(0.7 * old.height_at(xy) + 0.3 * new.height_at(xy))


@pytest.mark.parametrize("direction", [(1.0, 1.0, 0.5), (0.1, 0.3, 0.2), (0.3, -0.7, 0.1), (0.0, 0.1, 0.2)])
def test_points_on_one_line_leave_the_plane_as_it_was(direction: tuple[float, ...]) -> None:
    """The feet of a robot that lies on its side: the next plane that is one counts again."""
    old, line = plane(0.1, (0.2, 0.0)), np.outer([0.0, 1.0, 2.0, 3.0], direction)
    kept = blend(old, fit_plane(line, np.array([1.0, 0.0])), 0.3)
    assert kept == old.moved_to((1.0, 0.0))
