"""The plan's clock stops as gently as an inverted pendulum can and starts again."""

import math

import numpy as np
import pytest

from quadlab.controllers.tracking.plan_clock import PlanClock

TIME_CONSTANT, PERIOD, SPEED = 0.22, 0.0025, 0.25  # [s], [s], [m/s]


def run(clock: PlanClock, waits: bool, duration_s: float) -> None:
    for _ in range(round(duration_s / PERIOD)):
        clock.advance(waits, PERIOD)


def test_clock_that_never_waits_keeps_time() -> None:
    clock = PlanClock(TIME_CONSTANT)
    run(clock, False, 1.0)
    assert (clock.rate, clock.rate_change, clock.waited_s) == (1.0, 0.0, 0.0)


def test_stopping_centre_of_mass_needs_a_centre_of_pressure_at_rest_in_its_capture_point() -> None:
    """x_ddot = (x - p) / T^2 gives p = x - T^2 x_ddot, which must not move and be x_0 + T v_0."""
    clock, position, pressure = PlanClock(TIME_CONSTANT), 0.0, []
    for _ in range(400):
        clock.advance(True, PERIOD)
        position += clock.rate * SPEED * PERIOD
        pressure.append(position - TIME_CONSTANT**2 * clock.rate_change * SPEED)
    np.testing.assert_allclose(pressure, TIME_CONSTANT * SPEED, atol=0.01 * TIME_CONSTANT * SPEED)


def test_clock_starts_again_and_is_late_by_what_it_waited() -> None:
    clock = PlanClock(TIME_CONSTANT)
    run(clock, True, 2.0)
    assert clock.rate == pytest.approx(math.exp(-2.0 / TIME_CONSTANT))
    run(clock, False, 2.0)
    assert clock.rate == pytest.approx(1.0, abs=2e-4)
    assert clock.waited_s == pytest.approx(2.0, abs=PERIOD)
