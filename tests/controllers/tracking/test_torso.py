"""Attitude of the torso on sloped ground, and the axes of the ground."""

import math

import numpy as np
import pytest

from quadlab.controllers.tracking.torso import ground_axes, torso_rotation
from quadlab.estimation.terrain_plane import TerrainPlane
from quadlab.geometry.rotations import Array, euler_zyx, yaw_of

YAWS = (0.0, 0.9, -2.5)
yaws = pytest.mark.parametrize("yaw", YAWS)


def sloped(forward: float, left: float, yaw: float) -> TerrainPlane:
    """Ground that rises by ``forward`` along the heading and by ``left`` to its left."""
    c, s = math.cos(yaw), math.sin(yaw)
    return TerrainPlane((0.0, 0.0), 0.0, (c * forward - s * left, s * forward + c * left))


def steepness(direction: Array) -> float:
    return float(direction[2] / np.hypot(direction[0], direction[1]))


@yaws
@pytest.mark.parametrize(("forward", "left"), [(0.3, 0.0), (-0.2, 0.0), (0.25, -0.15)])
def test_base_points_along_the_ground_that_rises_ahead(yaw: float, forward: float, left: float) -> None:
    """Nose up uphill: with full slope following the base's x axis lies in the plane."""
    terrain = sloped(forward, left, yaw)
    x_axis = torso_rotation(yaw, terrain, 1.0)[:, 0]
    assert x_axis @ terrain.normal == pytest.approx(0.0, abs=1e-12)
    assert math.copysign(1.0, x_axis[2]) == math.copysign(1.0, forward)


@yaws
@pytest.mark.parametrize("left", [0.3, -0.2])
def test_base_leans_with_the_ground_that_rises_on_the_left(yaw: float, left: float) -> None:
    terrain = sloped(0.0, left, yaw)
    y_axis = torso_rotation(yaw, terrain, 1.0)[:, 1]
    assert y_axis @ terrain.normal == pytest.approx(0.0, abs=1e-12)
    assert math.copysign(1.0, y_axis[2]) == math.copysign(1.0, left)


@yaws
@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_torso_keeps_its_heading_and_a_share_of_the_slope(yaw: float, share: float) -> None:
    rotation = torso_rotation(yaw, sloped(0.2, -0.1, yaw), share)
    _, pitch, roll = euler_zyx(rotation)
    assert yaw_of(rotation) == pytest.approx(yaw)
    assert math.tan(pitch) == pytest.approx(-share * 0.2)
    assert math.tan(roll) == pytest.approx(-share * 0.1)


@yaws
@pytest.mark.parametrize("slope", [(0.0, 0.0), (0.4, 0.0), (-0.2, 0.3)])
def test_ground_axes_are_a_right_handed_frame_of_the_plane(yaw: float, slope: tuple[float, float]) -> None:
    terrain = TerrainPlane((0.0, 0.0), 0.0, slope)
    axes = ground_axes(yaw, terrain)
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    np.testing.assert_allclose(axes[:, 2], terrain.normal, atol=1e-12)
    assert axes[2, 2] > 0.0
    assert steepness(axes[:, 0]) == pytest.approx(np.array(slope) @ axes[:2, 0] / np.hypot(*axes[:2, 0]))


@yaws
@pytest.mark.parametrize(("forward", "left"), [(0.0, 0.0), (0.4, 0.0), (0.0, -0.3)])
def test_first_ground_axis_is_the_heading(yaw: float, forward: float, left: float) -> None:
    """On ground that rises along or across the heading there is only one direction that it can be laid to."""
    heading = ground_axes(yaw, sloped(forward, left, yaw))[:, 0]
    assert math.atan2(heading[1], heading[0]) == pytest.approx(yaw)
    assert steepness(heading) == pytest.approx(forward, abs=1e-12)
