"""Quaternions against an independent implementation."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quadlab.geometry.quaternions import quat_exp, quat_inverse, quat_log, quat_product

RNG = np.random.default_rng(5)
VECTORS = RNG.uniform(-1.5, 1.5, (20, 3))
OTHERS = RNG.uniform(-1.5, 1.5, (20, 3))


def test_exponential_turns_by_the_rotation_vector() -> None:
    expected = Rotation.from_rotvec(VECTORS).as_matrix()
    matrices = Rotation.from_quat(quat_exp(VECTORS), scalar_first=True).as_matrix()
    np.testing.assert_allclose(matrices, expected, atol=1e-12)


def test_product_turns_by_the_right_one_first() -> None:
    left, right = Rotation.from_rotvec(VECTORS), Rotation.from_rotvec(OTHERS)
    products = Rotation.from_quat(quat_product(quat_exp(VECTORS), quat_exp(OTHERS)), scalar_first=True)
    np.testing.assert_allclose(products.as_matrix(), (left * right).as_matrix(), atol=1e-12)


def test_inverse_undoes_the_turn() -> None:
    quats = quat_exp(VECTORS)
    np.testing.assert_allclose(quat_product(quats, quat_inverse(quats)), np.eye(4)[:1].repeat(20, axis=0), atol=1e-12)


@pytest.mark.parametrize("angle", [0.0, 1e-14, 1e-9, 1e-4, 0.7, np.pi, 5.0, 6.2])
def test_logarithm_inverts_the_exponential_up_to_a_full_turn(angle: float) -> None:
    vectors = angle * VECTORS / np.linalg.norm(VECTORS, axis=1, keepdims=True)
    np.testing.assert_allclose(quat_log(quat_exp(vectors)), vectors, rtol=1e-9, atol=1e-15)
