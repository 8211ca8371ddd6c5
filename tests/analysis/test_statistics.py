"""Intervals agree with published and independent values, and cover the truth as often as they promise."""

import math

import numpy as np
import pytest
from scipy.stats import binom, binomtest, permutation_test, ttest_rel

from quadlab.analysis.statistics import (
    holm_adjusted,
    paired_mean_difference,
    paired_share_difference,
    sign_flip_probability,
    wilson_interval,
)


@pytest.mark.parametrize(("successes", "count"), [(0, 10), (1, 1), (7, 10), (10, 10), (81, 263), (499, 500)])
@pytest.mark.parametrize("confidence", [0.8, 0.95, 0.99])
def test_wilson_agrees_with_scipy(successes: int, count: int, confidence: float) -> None:
    ours = wilson_interval(successes, count, confidence)
    theirs = binomtest(successes, count).proportion_ci(confidence, method="wilson")
    assert (ours.lower, ours.upper) == pytest.approx((theirs.low, theirs.high), abs=1e-12)
    assert ours.estimate == successes / count


def test_wilson_of_newcombe_1998() -> None:
    """Newcombe, Statistics in Medicine 17, 857: 81 of 263 and 0 of 20."""
    assert (wilson_interval(81, 263).lower, wilson_interval(81, 263).upper) == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert wilson_interval(0, 20).upper == pytest.approx(0.1611, abs=5e-5)


def test_no_trial_says_nothing() -> None:
    interval = wilson_interval(0, 0)
    assert math.isnan(interval.estimate)
    assert (interval.lower, interval.upper) == (0.0, 1.0)


@pytest.mark.parametrize("share", [0.5, 0.8, 0.9])
def test_wilson_covers_the_true_share_about_as_often_as_promised(share: float) -> None:
    count = 30
    covered = [w.lower <= share <= w.upper for k in range(count + 1) for w in [wilson_interval(k, count)]]
    assert 0.92 < float(np.dot(binom.pmf(np.arange(count + 1), count, share), covered)) < 0.99


def test_mean_difference_agrees_with_the_paired_t_test() -> None:
    rng = np.random.default_rng(3)
    first = rng.normal(5.0, 2.0, 12)
    second = first + rng.normal(0.4, 0.5, 12)
    expected = ttest_rel(second, first).confidence_interval(0.95)
    interval = paired_mean_difference(first, second)
    assert (interval.lower, interval.upper) == pytest.approx((expected.low, expected.high))
    assert interval.estimate == pytest.approx(float(np.mean(second - first)))


def test_pairing_removes_what_the_conditions_share() -> None:
    conditions = np.linspace(0.0, 100.0, 20)
    interval = paired_mean_difference(conditions, conditions + 1.0)
    assert (interval.lower, interval.upper) == pytest.approx((1.0, 1.0))


def test_one_pair_has_no_interval() -> None:
    interval = paired_mean_difference(np.array([1.0]), np.array([3.0]))
    assert interval.estimate == 2.0
    assert math.isnan(interval.lower)


def test_pairs_that_all_agree_still_leave_doubt() -> None:
    interval = paired_share_difference(0, 0, 10)
    assert interval.estimate == 0.0
    assert interval.lower < -0.1
    assert interval.upper > 0.1


def test_share_difference_of_bonett_and_price_by_hand() -> None:
    """Of 20 pairs the first alone succeeds in 1 and the second alone in 5: with one more each, 2 and 6 of 22."""
    interval = paired_share_difference(1, 5, 20)
    assert interval.estimate == pytest.approx(0.2)
    assert (interval.lower, interval.upper) == pytest.approx((-0.0584, 0.4221), abs=5e-5)


def test_share_difference_covers_the_true_one_about_as_often_as_promised() -> None:
    rng = np.random.default_rng(1)
    draws = rng.multinomial(20, [0.1, 0.3, 0.6], size=4000)
    intervals = [paired_share_difference(int(a), int(b), 20) for a, b, _ in draws]
    covered = np.mean([interval.lower <= 0.2 <= interval.upper for interval in intervals])
    assert 0.93 < covered < 0.98


@pytest.mark.parametrize(("arguments"), [(11, 10), (-1, 10)])
def test_impossible_counts_are_refused(arguments: tuple[int, int]) -> None:
    with pytest.raises(ValueError, match="successes in 10 trials"):
        wilson_interval(*arguments)


def test_unequal_or_missing_pairs_are_refused() -> None:
    with pytest.raises(ValueError, match="same number"):
        paired_mean_difference(np.zeros(2), np.zeros(3))
    with pytest.raises(ValueError, match="not finite"):
        paired_mean_difference(np.zeros(2), np.array([0.0, np.nan]))


@pytest.mark.parametrize(("count", "tolerance"), [(3, 1e-12), (12, 1e-12), (40, 0.01)])
def test_turning_signs_agrees_with_scipy(count: int, tolerance: float) -> None:
    rng = np.random.default_rng(count)
    first = rng.normal(5.0, 2.0, count)
    second = first + rng.normal(0.3, 1.0, count)
    theirs = permutation_test(
        (second - first,), np.mean, permutation_type="samples", n_resamples=9999, rng=np.random.default_rng(1)
    )
    assert sign_flip_probability(first, second) == pytest.approx(theirs.pvalue, abs=tolerance)


def test_few_pairs_that_differ_cannot_be_sure_however_alike_they_are() -> None:
    """A Student interval over a hundred pairs of which five differ would be."""
    first, second = np.zeros(100), np.zeros(100)
    second[:5] = [1.0, 1.0, 0.5, 0.5, 0.5]
    assert paired_mean_difference(first, second).lower > 0.0
    assert sign_flip_probability(first, second) == pytest.approx(2 / 2**5)
    assert sign_flip_probability(first, first) == 1.0


def test_signs_that_are_turned_at_random_never_make_sure() -> None:
    """The order that was observed is one of those that could be."""
    assert sign_flip_probability(np.zeros(40), np.ones(40), resamples=999) == pytest.approx(1 / 1000)


def test_correction_of_holm_1979() -> None:
    """The smallest counts n times, the next n - 1 times, and none is smaller than one before it."""
    adjusted = holm_adjusted(np.array([0.04, 0.01, 0.03, 0.9]))
    assert adjusted.tolist() == pytest.approx([0.09, 0.04, 0.09, 0.9])
    assert holm_adjusted(np.array([0.8, 0.6])).tolist() == [1.0, 1.0]
