"""A foot counts as standing soon after it is loaded, and does not chatter."""

import numpy as np

from quadlab.estimation.contact_detection import ContactDetectionConfig, ContactDetector

WEIGHT, PERIOD = 300.0, 0.0025  # [N], [s]


def detector(settling_s: float = 0.0, time_constant_s: float = 0.0) -> ContactDetector:
    config = ContactDetectionConfig(
        touch_down_share=0.06, lift_off_share=0.03, settling_s=settling_s, time_constant_s=time_constant_s
    )
    return ContactDetector(config, WEIGHT, PERIOD)


def test_force_between_the_thresholds_changes_nothing() -> None:
    trigger = detector()
    between = np.full(4, 0.045 * WEIGHT)
    assert not trigger.update(between).any()
    assert trigger.update(np.array([0.0, 20.0, 0.0, 20.0])).tolist() == [False, True, False, True]
    assert trigger.update(between).tolist() == [False, True, False, True]
    assert trigger.update(np.full(4, 8.0)).tolist() == [False] * 4


def test_noise_around_a_threshold_does_not_chatter() -> None:
    trigger, random = detector(), np.random.default_rng(0)
    noisy = [trigger.update(0.06 * WEIGHT + random.normal(size=4)) for _ in range(400)]
    changes = np.abs(np.diff(np.array(noisy).astype(int), axis=0)).sum(axis=0)
    assert changes.max() <= 1


def test_foot_settles_before_it_counts_and_a_bounce_starts_anew() -> None:
    trigger, load = detector(settling_s=0.01), np.full(4, 100.0)
    assert [bool(trigger.update(load)[0]) for _ in range(5)] == [False] * 4 + [True]
    trigger.update(np.zeros(4))
    assert [bool(trigger.update(load)[0]) for _ in range(5)] == [False] * 4 + [True]


def test_filter_delays_by_about_its_time_constant() -> None:
    trigger = detector(time_constant_s=0.02)
    load = np.full(4, 0.06 * WEIGHT / (1.0 - np.exp(-1.0)))  # reaches the threshold after one time constant
    ticks = next(tick for tick in range(1, 100) if trigger.update(load)[0])
    assert 0.02 - 2 * PERIOD <= ticks * PERIOD <= 0.02 + 2 * PERIOD
