"""Piecewise polynomials: derivatives by finite differences, knots, rest outside the span; the quintic's boundaries."""

import numpy as np
import pytest

from quadlab.geometry.splines import PiecewisePolynomial, quintic_between

STEP = 1e-5


def curve(degree: int = 5) -> PiecewisePolynomial:
    coefficients = np.random.default_rng(0).normal(size=(3, degree + 1, 2))
    return PiecewisePolynomial(np.array([1.0, 1.4, 2.1, 3.0]), coefficients)


@pytest.mark.parametrize("derivative", [1, 2, 3])
@pytest.mark.parametrize("degree", [1, 4, 5])
@pytest.mark.parametrize("time", [1.1, 1.39, 1.7, 2.5, 2.99])
def test_derivatives_are_rates_of_change(degree: int, derivative: int, time: float) -> None:
    polynomial = curve(degree)
    rate = (polynomial(time + STEP, derivative - 1) - polynomial(time - STEP, derivative - 1)) / (2.0 * STEP)
    np.testing.assert_allclose(polynomial(time, derivative), rate, atol=1e-6)


def test_value_is_that_of_the_polynomial_in_local_time() -> None:
    polynomial = curve()
    for piece, knot in enumerate(polynomial.knots[:-1]):
        expected = [np.polynomial.Polynomial(column)(0.2) for column in polynomial.coefficients[piece].T]
        np.testing.assert_allclose(polynomial(knot + 0.2), expected)


def test_knot_belongs_to_the_later_piece_and_the_end_to_the_last() -> None:
    polynomial = curve()
    assert polynomial.locate(1.4) == (1, 0.0)
    piece, local = polynomial.locate(3.0)
    assert piece == 2
    assert local == pytest.approx(0.9)
    assert polynomial.span == (1.0, 3.0)
    assert polynomial.dimension == 2


@pytest.mark.parametrize("time", [0.5, 1.2, 3.0])
def test_coefficients_may_be_a_view_of_others(time: float) -> None:
    polynomial = curve()
    view = PiecewisePolynomial(polynomial.knots, polynomial.coefficients[:, :, :1])
    np.testing.assert_array_equal(view.motion(time), polynomial.motion(time)[:, :1])


@pytest.mark.parametrize(("outside", "end"), [(-2.0, 1.0), (0.999, 1.0), (3.001, 3.0), (9.0, 3.0)])
def test_curve_rests_at_its_ends_outside_its_span(outside: float, end: float) -> None:
    polynomial = curve()
    np.testing.assert_array_equal(polynomial(outside), polynomial(end))
    for derivative in (1, 2, 3):
        np.testing.assert_array_equal(polynomial(outside, derivative), np.zeros(2))
        assert np.any(polynomial(end, derivative) != 0.0)


def test_evaluation_leaves_the_curve_alone() -> None:
    polynomial = curve()
    before = polynomial(1.2)
    value = polynomial(1.2)
    value += 1.0
    np.testing.assert_array_equal(polynomial(1.2), before)


@pytest.mark.parametrize("duration", [0.3, 1.0, 4.0])
def test_quintic_joins_position_velocity_and_acceleration(duration: float) -> None:
    start, end = np.random.default_rng(1).normal(size=(2, 3, 2))
    coefficients = quintic_between(start, end, duration)
    assert coefficients.shape == (6, 2)
    joined = PiecewisePolynomial(np.array([0.0, duration]), coefficients[None])
    for derivative in range(3):
        np.testing.assert_allclose(joined(0.0, derivative), start[derivative], atol=1e-10)
        np.testing.assert_allclose(joined(duration, derivative), end[derivative], atol=1e-9)


def test_quintic_between_equal_states_of_rest_rests() -> None:
    state = np.array([[0.4, -1.0], [0.0, 0.0], [0.0, 0.0]])
    np.testing.assert_allclose(quintic_between(state, state, 0.7)[1:], 0.0, atol=1e-12)


@pytest.mark.parametrize("time_s", [-2.0, 1.0, 1.1, 1.4, 2.5, 3.0, 9.0])
def test_motion_is_value_and_two_derivatives(time_s: float) -> None:
    polynomial = curve()
    np.testing.assert_array_equal(polynomial.motion(time_s), [polynomial(time_s, order) for order in range(3)])
