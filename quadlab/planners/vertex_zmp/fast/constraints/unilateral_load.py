"""Feet push and never pull: the CoP stays in the hull of the feet in contact."""

import numpy as np

from quadlab.planners.vertex_zmp.fast.model import ReducedModel
from quadlab.planners.vertex_zmp.fast.rows import Inequalities, Rows


def unilateral_load(model: ReducedModel) -> Inequalities:
    """Return lambda >= 0 for every foot that has a share of its own, Winkler 2017, Eq. (19b), no unit.

    With two feet in contact lambda <= 1 is the same condition for the other one.
    """
    shared = model.columns.shared
    single = np.broadcast_to(shared.sum(axis=1, keepdims=True) == 1, shared.shape)[shared]
    columns = model.columns.loads[shared][:, None]
    rows = Rows("load_unilateral", columns, np.ones(columns.shape), np.zeros(len(columns)))
    return Inequalities(rows, np.zeros(len(columns)), np.where(single, 1.0, np.inf))


def unilateral_rest(model: ReducedModel) -> Inequalities:
    """Return that the foot that carries what the others leave does not pull either: sum lambda <= 1, Eq. (19a)."""
    shared = model.columns.shared
    several = shared.sum(axis=1) > 1
    columns = np.where(shared, model.columns.loads, 0)[several]
    values = shared[several].astype(float)
    rows = Rows("load_rest_unilateral", columns, values, np.zeros(len(columns)))
    return Inequalities(rows, np.full(len(columns), -np.inf), np.ones(len(columns)))
