"""The ZMP stays inside the support polygon, smaller by a margin."""

import numpy as np
from scipy.sparse import vstack

from quadlab.planners.zmp_spline.model import SplineModel
from quadlab.planners.zmp_spline.terms import Bound

NAME = "zmp_in_support_m"


def zmp_in_support(model: SplineModel, slack_weight: float | None) -> Bound:
    """Return n . u <= n . p - margin for every edge of the support at every sample, in [m].

    u = c - (h / g) c_ddot; at a contact switch the supports of both phases hold.

    Args:
        model: supports and samples.
        slack_weight: price of a squared violation over time in [1/s^4]; None for a hard constraint.
    """
    samples, phases = model.samples, model.grid.phases[model.samples.segments]
    rows, upper, times, spacing = [], [], [], []
    for phase, support in enumerate(model.supports):
        held = np.flatnonzero(phases == phase)
        for normal, offset in zip(support.normals, support.offsets, strict=True):
            directions = np.repeat(normal[None], len(held), axis=0)
            rows.append(model.grid.rows(samples.segments[held], model.zmp_weights[held], directions))
            upper.append(np.full(len(held), offset))
            times.append(samples.times_s[held])
            spacing.append(samples.spacing_s[held])
    weights = None if slack_weight is None else slack_weight * np.concatenate(spacing)
    return Bound(NAME, vstack(rows, format="csr"), np.concatenate(upper), np.concatenate(times), weights)
