"""A ZMP that keeps away from the edges."""

import numpy as np

from quadlab.planners.zmp_spline.model import SplineModel
from quadlab.planners.zmp_spline.terms import SquaredCost


def support_centre(model: SplineModel, weight: float) -> SquaredCost:
    """Return ``weight`` in [1/s^4] times the integral of |u - middle of the support|^2 (not in the paper)."""
    samples = model.samples
    middles = np.array([support.middle for support in model.supports])[model.grid.phases[samples.segments]]
    weights = np.repeat(model.zmp_weights, 2, axis=0)
    axes = np.tile(np.eye(2), (len(middles), 1))
    rows = model.grid.rows(np.repeat(samples.segments, 2), weights, axes)
    return SquaredCost("support_centre", rows, middles.ravel(), weight * np.repeat(samples.spacing_s, 2))
