"""Loads do not jump within a phase."""

import numpy as np

from quadlab.planners.vertex_zmp.fast.model import ReducedModel
from quadlab.planners.vertex_zmp.fast.rows import NO_PRODUCTS, Equalities, Rows, on_both_axes


def cop_continuity(model: ReducedModel) -> Equalities:
    """Return that both sides of a knot within a phase have the same CoP, in [m].

    They share a load node; load_balance holds for the interval that begins there, and this carries it over to the
    one that ends. Position and velocity need no constraint: neighbouring intervals share their state.
    """
    nodes = model.grid.nodes
    after = np.flatnonzero(nodes[1:, 0] == nodes[:-1, -1]) + 1  # intervals that share their first node
    before = after - 1
    ends = model.spline.cop_weights(before, np.ones(len(after)))
    starts = model.spline.cop_weights(after, np.zeros(len(after)))
    columns = np.concatenate([model.knot_columns(before), model.knot_columns(after)], axis=1)
    scales = np.minimum(model.spline.row_scales(before), model.spline.row_scales(after))
    both = on_both_axes(columns, scales[:, None] * np.concatenate([ends, -starts], axis=1))
    return Equalities(Rows("cop_continuity_m", *both, np.zeros(len(both[0]))), NO_PRODUCTS)
