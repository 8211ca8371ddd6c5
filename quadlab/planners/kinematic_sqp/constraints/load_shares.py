"""Eq. (8), second line: the loads of the feet that carry add up to one, each at least w_min."""

import numpy as np

from quadlab.gaits.schedule import BoolArray
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import Equality, Inequality, fix, rows
from quadlab.robots.legs import LEG_COUNT


def unloaded_feet(layout: SampleLayout, support: BoolArray) -> Equality:
    """Return w = 0 for every foot that does not carry."""
    return fix("unloaded_feet", layout.indices("loads")[~support], 0.0)


def load_sum(layout: SampleLayout, support: BoolArray) -> Equality:
    """Return sum_k w_k = 1 at every sample, solved for the last foot that carries."""
    samples = np.arange(layout.samples)
    last = LEG_COUNT - 1 - np.argmax(support[:, ::-1], axis=1)
    loads = layout.indices("loads")
    others = np.arange(LEG_COUNT)[None, :] != last[:, None]
    sources = loads[others].reshape(layout.samples, LEG_COUNT - 1)
    targets = loads[samples, last]
    return Equality("load_sum", targets, sources, -np.ones(sources.shape), np.ones(len(samples)))


def load_range(layout: SampleLayout, support: BoolArray, least: float) -> Inequality:
    """Return w_min <= w <= 1 for every foot that carries; w_min is at most an equal share.

    Args:
        layout: of p.
        support: which feet may carry, (N, 4).
        least: w_min.
    """
    shares = np.broadcast_to(1.0 / support.sum(axis=1, keepdims=True), support.shape)
    index = layout.indices("loads")[support]
    lower = np.minimum(least, shares[support])
    return Inequality("load_range", rows([(index, 1.0)], layout.size), lower, np.ones(len(index)), often_active=True)
