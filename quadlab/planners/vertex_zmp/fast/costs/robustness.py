"""Load spread evenly over the feet in contact."""

import numpy as np

from quadlab.planners.vertex_zmp.fast.model import ReducedModel
from quadlab.planners.vertex_zmp.fast.rows import Rows


def robustness(model: ReducedModel) -> Rows:
    """Return rows whose squares add up to the deviation from equal load, Winkler 2017, Eq. (20)-(21), in [s].

    J = int ||lambda - lambda*||^2 dt with lambda* = 1 / (number of feet in contact); exact for loads linear in time:
    T / 3 (a^2 + a b + b^2) = T / 3 ((a + b / 2)^2 + 3 / 4 b^2).
    """
    contacts = model.grid.node_contacts[model.grid.nodes[:, 0]]
    intervals, feet = np.nonzero(contacts)
    begin, end = model.grid.nodes[intervals].T
    columns_a, values_a, constant_a = _deviations(model, begin, feet)
    columns_b, values_b, constant_b = _deviations(model, end, feet)
    scale = np.sqrt(model.grid.durations_s[intervals] / 3.0)
    half = np.sqrt(0.75) * scale
    columns = np.concatenate([columns_a, columns_b], axis=1)
    sums = np.concatenate([scale[:, None] * values_a, 0.5 * scale[:, None] * values_b], axis=1)
    ends = np.concatenate([np.zeros_like(values_a), half[:, None] * values_b], axis=1)
    constants = np.concatenate([scale * (constant_a + 0.5 * constant_b), half * constant_b])
    return Rows("robustness", np.concatenate([columns, columns]), np.concatenate([sums, ends]), constants)


def _deviations(model: ReducedModel, nodes: np.ndarray, feet: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return lambda - lambda* of given feet at given nodes: columns and values (m, F), constants (m,)."""
    shared, loads = model.columns.shared[nodes], model.columns.loads[nodes]
    rest = feet == model.columns.last_feet[nodes]
    own = np.arange(shared.shape[1]) == feet[:, None]
    values = np.where(rest[:, None], -1.0, own.astype(float)) * shared
    even = 1.0 / model.grid.node_contacts[nodes].sum(axis=1)
    return np.where(shared, loads, 0), values, rest - even
