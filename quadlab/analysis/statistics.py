"""Intervals for shares and for paired differences: what few trials can and cannot show."""

import math
from dataclasses import dataclass
from itertools import product
from statistics import NormalDist

import numpy as np
from scipy.special import stdtrit  # scipy.stats takes half a second to import

from quadlab.geometry.rotations import Array

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Interval:
    """An estimate and the interval in which the true value lies with the confidence asked for.

    Attributes:
        estimate: from the sample.
        lower, upper: bounds; NaN if the sample is too small to say.
        count: size of the sample.
    """

    estimate: float
    lower: float
    upper: float
    count: int


def wilson_interval(successes: int, count: int, confidence: float = CONFIDENCE) -> Interval:
    """Return the share of successes with its score interval.

    Wilson 1927, "Probable inference, the law of succession, and statistical inference", without continuity correction:
    bounded by 0 and 1, and not of zero width when all trials succeed or all fail.

    Args:
        successes: number of successes, 0 to ``count``.
        count: number of trials; with none the share is NaN and the interval [0, 1].
        confidence: probability that the interval covers the true share, between 0 and 1.

    Raises:
        ValueError: if an argument is out of range.
    """
    _check_confidence(confidence)
    if not 0 <= successes <= count:
        raise ValueError(f"{successes} successes in {count} trials; expected 0 to {count}")
    if count == 0:
        return Interval(math.nan, 0.0, 1.0, 0)
    z = _normal_quantile(confidence)
    share, shrink = successes / count, 1.0 + z**2 / count
    centre = (share + z**2 / (2 * count)) / shrink
    half_width = z / shrink * math.sqrt(share * (1.0 - share) / count + z**2 / (4 * count**2))
    lower = 0.0 if successes == 0 else centre - half_width
    upper = 1.0 if successes == count else centre + half_width
    return Interval(share, lower, upper, count)


def paired_mean_difference(first: Array, second: Array, confidence: float = CONFIDENCE) -> Interval:
    """Return the mean of ``second - first`` over pairs with Student's interval.

    Args:
        first, second: (n,) values of the same n conditions; both finite.
        confidence: see ``wilson_interval``.

    Returns:
        The mean difference; bounds are NaN for fewer than two pairs.

    Raises:
        ValueError: if the shapes differ or a value is not finite.
    """
    _check_confidence(confidence)
    differences = _paired(first, second)
    count = len(differences)
    if count == 0:
        return Interval(math.nan, math.nan, math.nan, 0)
    mean = float(differences.mean())
    if count == 1:
        return Interval(mean, math.nan, math.nan, 1)
    quantile = float(stdtrit(count - 1, 0.5 + confidence / 2.0))
    half_width = quantile * float(differences.std(ddof=1)) / math.sqrt(count)
    return Interval(mean, mean - half_width, mean + half_width, count)


def paired_share_difference(only_first: int, only_second: int, count: int, confidence: float = CONFIDENCE) -> Interval:
    """Return how much larger the second of two paired shares of success is, with its interval.

    Bonett and Price 2012, "Adjusted Wald confidence interval for a difference of binomial proportions based on paired
    data": one pair of each kind of disagreement is added, so that it has a width when all pairs agree.

    Args:
        only_first: pairs in which only the first succeeded.
        only_second: pairs in which only the second succeeded.
        count: number of pairs.
        confidence: see ``wilson_interval``.

    Raises:
        ValueError: if an argument is out of range.
    """
    _check_confidence(confidence)
    if min(only_first, only_second) < 0 or only_first + only_second > count:
        raise ValueError(f"{only_first} + {only_second} pairs that disagree among {count}")
    if count == 0:
        return Interval(math.nan, -1.0, 1.0, 0)
    p_first, p_second = (only_first + 1) / (count + 2), (only_second + 1) / (count + 2)
    centre = p_second - p_first
    variance = (p_first + p_second - centre**2) / (count + 2)
    half_width = _normal_quantile(confidence) * math.sqrt(variance)
    difference = (only_second - only_first) / count
    return Interval(difference, max(-1.0, centre - half_width), min(1.0, centre + half_width), count)


def sign_flip_probability(first: Array, second: Array, resamples: int = 9999) -> float:
    """Return the two-sided probability of a mean difference of pairs as large as this if neither were larger.

    A permutation test (Fisher 1935, "The design of experiments"): if neither is larger, each pair could as well be the
    other way round. It assumes independent pairs and no distribution; five pairs never give less than 1/16. Pairs that
    are equal count for neither. All ways to turn the pairs are tried where these are not more than ``resamples``, else
    so many at random, the same in every call.

    Args:
        first, second: (n,) values of the same n conditions; both finite.
        resamples: at most.

    Raises:
        ValueError: if the shapes differ or a value is not finite.
    """
    differences = _paired(first, second)
    differences = differences[differences != 0.0]
    count = len(differences)
    if count == 0:
        return 1.0
    observed = abs(differences.sum()) * (1.0 - 1e-12)  # sums in another order round otherwise
    if 2**count <= resamples:
        turned = np.array(list(product((-1.0, 1.0), repeat=count)))
        return float(np.mean(np.abs(turned @ differences) >= observed))
    random = np.random.default_rng(0)
    turned = random.choice((-1.0, 1.0), (resamples, count))
    return float((1 + np.count_nonzero(np.abs(turned @ differences) >= observed)) / (resamples + 1))


def holm_adjusted(probabilities: Array) -> Array:
    """Return probabilities (n,) of n tests, corrected so that all of them together err no more often than one.

    Holm 1979, "A simple sequentially rejective multiple test procedure".
    """
    order = np.argsort(probabilities, kind="stable")
    factors = len(probabilities) - np.arange(len(probabilities))
    adjusted = np.empty(len(probabilities))
    adjusted[order] = np.minimum(np.maximum.accumulate(factors * probabilities[order]), 1.0)
    return adjusted


def _normal_quantile(confidence: float) -> float:
    return NormalDist().inv_cdf(0.5 + confidence / 2.0)


def _paired(first: Array, second: Array) -> Array:
    first, second = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    if first.shape != second.shape or first.ndim != 1:
        raise ValueError(f"pairs of shapes {first.shape} and {second.shape}; expected the same number in each")
    if not (np.isfinite(first).all() and np.isfinite(second).all()):
        raise ValueError("a value of a pair is not finite; leave such pairs out and say how many")
    return second - first


def _check_confidence(confidence: float) -> None:
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence {confidence} is not between 0 and 1")
