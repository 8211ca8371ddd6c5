"""A pendulum curve is what its differential equation says."""

import numpy as np
import pytest

from quadlab.geometry.lip_curve import LipCurve

RATE = 4.0  # [1/s]
KNOTS = np.array([0.5, 0.6, 0.9])
CURVE = LipCurve(KNOTS, np.random.default_rng(0).standard_normal((2, 4, 3)), RATE)


@pytest.mark.parametrize("derivative", [1, 2, 3])
@pytest.mark.parametrize("time_s", [0.52, 0.59, 0.61, 0.85])
def test_derivatives_agree_with_finite_differences(time_s: float, derivative: int) -> None:
    change = (CURVE(time_s + 1e-6, derivative - 1) - CURVE(time_s - 1e-6, derivative - 1)) / 2e-6
    np.testing.assert_allclose(CURVE(time_s, derivative), change, rtol=1e-6, atol=1e-6)


def test_acceleration_is_that_of_a_pendulum_about_a_moving_point() -> None:
    offset, slope = CURVE.coefficients[1, 0], CURVE.coefficients[1, 1]
    for local in (0.0, 0.1, 0.25):
        time = 0.6 + local
        expected = RATE**2 * (CURVE(time) - offset - slope * local)
        np.testing.assert_allclose(CURVE(time, 2), expected, atol=1e-9)


def test_curve_rests_outside_its_span() -> None:
    assert CURVE.span == (0.5, 0.9)
    assert CURVE.dimension == 3
    for time in (0.0, 2.0):
        np.testing.assert_array_equal(CURVE(time, 1), np.zeros(3))
    np.testing.assert_array_equal(CURVE(2.0), CURVE(0.9))


@pytest.mark.parametrize("derivative", [0, 1, 2, 3])
def test_evaluation_of_many_times_agrees_with_single_ones(derivative: int) -> None:
    pieces, local = np.array([0, 0, 1, 1]), np.array([0.0, 0.07, 0.0, 0.2])
    single = [CURVE(float(KNOTS[piece] + time), derivative) for piece, time in zip(pieces, local, strict=True)]
    np.testing.assert_allclose(CURVE.on_pieces(pieces, local, derivative), single, atol=1e-12)


@pytest.mark.parametrize("time_s", [0.0, 0.5, 0.55, 0.6, 0.83, 0.9, 2.0])
def test_motion_is_value_and_two_derivatives(time_s: float) -> None:
    np.testing.assert_allclose(CURVE.motion(time_s), [CURVE(time_s, order) for order in range(3)], atol=1e-12)
