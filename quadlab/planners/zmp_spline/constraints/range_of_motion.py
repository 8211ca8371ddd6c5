"""Feet stay where the legs can reach."""

import numpy as np
from scipy.sparse import vstack

from quadlab.planners.zmp_spline.model import SplineModel
from quadlab.planners.zmp_spline.terms import Bound


def range_of_motion(model: SplineModel, margin_m: float) -> Bound:
    """Return that the CoM keeps every foot, standing or swinging, in its box, in [m].

    |R(psi)^T (p - c) - p_nominal| <= reach - margin (Winkler 2017, Eq. 15) with given p: the tightest foot counts on
    each side. At time 0 there is nothing to decide and no constraint. Bellicoso 2016 has no such constraint.
    """
    samples = model.samples
    held = np.flatnonzero(samples.times_s > 0.0)
    segments, feet = samples.segments[held], model.feet[held]
    weights = model.grid.weights(segments, samples.local_s[held], 0)
    yaw = model.heading.on_pieces(*_pieces(model, samples.times_s[held]))[:, 0]
    forward = np.stack([np.cos(yaw), np.sin(yaw)], axis=1)
    left = np.stack([-np.sin(yaw), np.cos(yaw)], axis=1)
    reach = model.problem.model.reach - margin_m
    rows, upper = [], []
    for axis, directions in enumerate((forward, left)):
        centres = np.einsum("sfa,sa->sf", feet, directions) - model.problem.model.nominal_feet[:, axis]
        position = model.grid.rows(segments, weights, directions)
        rows += [position, -position]
        upper += [centres.min(axis=1) + reach[axis], reach[axis] - centres.max(axis=1)]
    times = np.tile(samples.times_s[held], 4)
    return Bound("range_of_motion_m", vstack(rows, format="csr"), np.concatenate(upper), times)


def _pieces(model: SplineModel, times_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return piece of the heading and time in it at ``times_s``, both (s,); the heading ends at rest."""
    knots = model.heading.knots
    inside = np.clip(times_s, knots[0], knots[-1])
    pieces = np.clip(np.searchsorted(knots, inside, side="right") - 1, 0, len(knots) - 2)
    return pieces, inside - knots[pieces]
