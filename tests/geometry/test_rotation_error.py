"""The turn between two orientations."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quadlab.geometry.rotation_error import rotation_error
from quadlab.geometry.rotations import rotation_log, rotation_z, rotation_zyx


@pytest.mark.parametrize("angle", [0.0, 1e-13, 1e-6, 0.4, -2.0, 3.14, np.pi - 1e-7, np.pi])
def test_error_is_the_angle_about_the_axis_also_near_half_a_turn(angle: float) -> None:
    other = rotation_zyx(0.3, -0.2, 0.1)
    error = rotation_error(rotation_z(angle) @ other, other)
    np.testing.assert_allclose(np.abs(error), [0.0, 0.0, abs(angle)], atol=1e-9)
    np.testing.assert_allclose(error, rotation_log(rotation_z(angle) @ other @ other.T), atol=1e-9)


def test_error_turns_one_orientation_into_the_other() -> None:
    rotation, other = rotation_zyx(1.0, 0.2, -0.4), rotation_zyx(-0.5, 0.1, 0.3)
    error = rotation_error(rotation, other)
    np.testing.assert_allclose(Rotation.from_rotvec(error).as_matrix() @ other, rotation, atol=1e-12)
    np.testing.assert_allclose(rotation_error(other, rotation), -error, atol=1e-14)
