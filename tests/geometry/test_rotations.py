"""Rotations against an independent implementation, and their round trips."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from quadlab.geometry.rotations import (
    Array,
    euler_zyx,
    matrix_to_quat,
    quat_to_matrix,
    rotation_2d,
    rotation_log,
    rotation_z,
    rotation_zyx,
    skew,
    tilt_of,
    wrap_angle,
    yaw_of,
)

AXES = [np.array(axis) / np.linalg.norm(axis) for axis in ([1, 0, 0], [0, -1, 0], [0, 0, 1], [1, -2, 3], [-3, 1, 0.1])]
ANGLES = [0.0, 1e-14, 1e-9, 1e-4, 0.7, 2.5, math.pi - 1e-4, math.pi - 1e-9, math.pi]
quaternions = st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1)
angles = st.floats(-1.5, 1.5)


def turn(axis: Array, angle: float) -> Array:
    """Rodrigues' formula."""
    cross = skew(axis)
    return np.asarray(np.eye(3) + math.sin(angle) * cross + 2.0 * math.sin(0.5 * angle) ** 2 * cross @ cross)


@given(quaternions)
@settings(max_examples=60, deadline=None)
def test_quaternion_and_matrix_round_trip(components: list[float]) -> None:
    quat = np.array(components) / np.linalg.norm(components)
    matrix = quat_to_matrix(quat)
    np.testing.assert_allclose(matrix, Rotation.from_quat(quat, scalar_first=True).as_matrix(), atol=1e-12)
    back = matrix_to_quat(matrix)
    assert back[0] >= 0.0
    assert np.linalg.norm(back) == pytest.approx(1.0)
    assert abs(back @ quat) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("axis", AXES, ids=str)
@pytest.mark.parametrize("angle", ANGLES)
def test_log_inverts_the_turn_about_an_axis(axis: Array, angle: float) -> None:
    """Also where the rotation vector is lost to naive formulas: near 0 and near half a turn."""
    vector = rotation_log(turn(axis, angle))
    sign = -1.0 if angle == math.pi and vector @ axis < 0.0 else 1.0  # half a turn has two logarithms
    np.testing.assert_allclose(sign * vector, angle * axis, rtol=1e-7, atol=1e-12)


@given(angles, angles, angles)
@settings(max_examples=60, deadline=None)
def test_euler_angles_round_trip(yaw: float, pitch: float, roll: float) -> None:
    matrix = rotation_zyx(2.0 * yaw, pitch, 2.0 * roll)
    expected = Rotation.from_euler("ZYX", [2.0 * yaw, pitch, 2.0 * roll]).as_matrix()
    np.testing.assert_allclose(matrix, expected, atol=1e-12)
    np.testing.assert_allclose(euler_zyx(matrix), [2.0 * yaw, pitch, 2.0 * roll], atol=1e-9)


def test_euler_angles_of_a_vertical_robot_are_finite() -> None:
    for pitch in (0.5 * math.pi, -0.5 * math.pi):
        yaw, measured, roll = euler_zyx(rotation_zyx(0.3, pitch, 0.2))
        assert measured == pytest.approx(pitch, abs=1e-7)
        assert math.isfinite(yaw)
        assert math.isfinite(roll)


@given(st.floats(-100.0, 100.0))
@settings(max_examples=100, deadline=None)
def test_wrapped_angle_points_the_same_way_within_half_a_turn(angle: float) -> None:
    wrapped = wrap_angle(angle)
    assert -math.pi <= wrapped <= math.pi
    assert math.cos(wrapped - angle) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("angle", [-3.0, -0.4, 0.0, 1.0, 3.1])
def test_planar_rotations_turn_counter_clockwise(angle: float) -> None:
    np.testing.assert_allclose(rotation_2d(angle) @ [1.0, 0.0], [math.cos(angle), math.sin(angle)])
    np.testing.assert_allclose(rotation_z(angle)[:2, :2], rotation_2d(angle))
    np.testing.assert_allclose(rotation_z(angle), rotation_zyx(angle, 0.0, 0.0))
    assert yaw_of(rotation_z(angle)) == pytest.approx(angle)


def test_heading_does_not_depend_on_roll_and_pitch() -> None:
    assert yaw_of(rotation_zyx(0.8, 0.5, -1.0)) == pytest.approx(0.8)


@pytest.mark.parametrize("axis", [AXES[0], AXES[1]], ids=str)
@pytest.mark.parametrize("angle", [0.0, 0.3, 1.8, math.pi])
def test_tilt_is_the_angle_about_a_horizontal_axis(axis: Array, angle: float) -> None:
    assert tilt_of(rotation_z(1.1) @ turn(axis, angle)) == pytest.approx(angle, abs=1e-7)


def test_skew_is_the_cross_product() -> None:
    a, b = np.array([0.3, -1.0, 2.0]), np.array([0.7, 0.1, -0.4])
    np.testing.assert_allclose(skew(a) @ b, np.cross(a, b))
