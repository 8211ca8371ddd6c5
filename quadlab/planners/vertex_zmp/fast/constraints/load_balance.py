"""The pendulum turns about the point where the feet push."""

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.model import ReducedModel
from quadlab.planners.vertex_zmp.fast.rows import Equalities, Products, Rows, on_both_axes
from quadlab.planners.vertex_zmp.footholds import IntArray
from quadlab.planners.vertex_zmp.grid import TimeGrid


def load_balance(model: ReducedModel) -> Equalities:
    """Return u(x) = sum_f lambda^f p^f at each load node, Winkler 2017, Eq. (12) and (17) for point feet, in [m].

    u(x) is the CoP that the motion between two knots implies. Loads are linear between nodes, so the CoP is in the
    hull of the feet everywhere if it is at the nodes: a combination of points of a convex set stays in the set.
    Rows of intervals of a few milliseconds are scaled down.

    Deviation: the exact pendulum in place of a quartic that satisfies it at three instants.
    """
    intervals, fractions = _node_places(model.grid)
    columns = model.knot_columns(intervals)
    values = model.spline.cop_weights(intervals, fractions)
    last = _stance_columns(model)[np.arange(len(intervals)), model.columns.last_feet]
    columns = np.concatenate([columns, last[:, None, :]], axis=1)
    values = np.concatenate([values, np.full((len(values), 1), -1.0)], axis=1)
    scales = model.spline.row_scales(intervals)
    both = on_both_axes(columns, scales[:, None] * values)
    return Equalities(Rows("load_balance_m", *both, np.zeros(len(both[0]))), _load_products(model, last, scales))


def _node_places(grid: TimeGrid) -> tuple[IntArray, Array]:
    """Return one (interval, elapsed fraction) for each node, both (N,)."""
    intervals = np.empty(len(grid.node_phases), dtype=np.intp)
    fractions = np.zeros(len(grid.node_phases))
    intervals[grid.nodes[:, 1]], fractions[grid.nodes[:, 1]] = np.arange(grid.count), 1.0
    intervals[grid.nodes[:, 0]], fractions[grid.nodes[:, 0]] = np.arange(grid.count), 0.0
    return intervals, fractions


def _stance_columns(model: ReducedModel) -> IntArray:
    """Return where the stance of each foot at each node sits, (N, feet, 2 axes)."""
    stances = model.footholds.phase_stances[model.grid.node_phases]
    return model.columns.stances[stances]


def _load_products(model: ReducedModel, last: IntArray, scales: Array) -> Products:
    """Return -lambda^f (p^f - p^last) for all feet that have a share of their own."""
    nodes, feet = np.nonzero(model.columns.shared)
    own = _stance_columns(model)[nodes, feet]
    loads = np.repeat(model.columns.loads[nodes, feet][:, None], 2, axis=1)
    rows = 2 * nodes[:, None] + np.arange(2)
    weights = np.repeat(scales[nodes], 2)
    return Products(
        rows=np.concatenate([rows.ravel(), rows.ravel()]),
        first=np.concatenate([loads.ravel(), loads.ravel()]),
        second=np.concatenate([own.ravel(), last[nodes].ravel()]),
        coefficients=np.concatenate([-weights, weights]),
    )
