"""Box-plus and box-minus undo each other and act as the error is defined."""

import numpy as np
import pinocchio as pin
import pytest
from estimation_cases import any_filter_state

from quadlab.estimation.error_state import (
    ACCELEROMETER_BIAS,
    ERROR_SIZE,
    FEET,
    GYRO_BIAS,
    ORIENTATION,
    POSITION,
    VELOCITY,
    box_minus,
    box_plus,
    foot_block,
    rotation_exp,
)
from quadlab.geometry.rotations import rotation_z, yaw_of


def test_blocks_cover_the_error_without_overlap() -> None:
    blocks = (POSITION, VELOCITY, ORIENTATION, FEET, ACCELEROMETER_BIAS, GYRO_BIAS)
    covered = np.concatenate([np.arange(ERROR_SIZE)[block] for block in blocks])
    np.testing.assert_array_equal(covered, np.arange(ERROR_SIZE))
    assert [foot_block(leg).start for leg in range(4)] == list(range(FEET.start, FEET.stop, 3))


@pytest.mark.parametrize("seed", range(5))
def test_box_minus_returns_what_box_plus_added(seed: int) -> None:
    state = any_filter_state(seed)
    error = np.random.default_rng(100 + seed).normal(scale=0.5, size=ERROR_SIZE)
    np.testing.assert_allclose(box_minus(box_plus(state, error), state), error, atol=1e-12)


def test_orientation_error_turns_the_whole_state_about_the_worlds_axes() -> None:
    state, error = any_filter_state(0), np.zeros(ERROR_SIZE)
    error[ORIENTATION][2] = 0.3  # [rad]
    turned, turn = box_plus(state, error), rotation_z(0.3)
    assert yaw_of(turned.rotation @ state.rotation.T) == pytest.approx(0.3)
    np.testing.assert_allclose(turned.position, turn @ state.position)
    np.testing.assert_allclose(turned.velocity, turn @ state.velocity)
    np.testing.assert_allclose(turned.feet, state.feet @ turn.T)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-5, 0.3, 2.0, 3.1])
def test_exponential_of_a_rotation_vector(angle: float) -> None:
    vector = angle * np.array([2.0, -1.0, 2.0]) / 3.0
    np.testing.assert_allclose(rotation_exp(vector), pin.exp3(vector), atol=1e-15)
