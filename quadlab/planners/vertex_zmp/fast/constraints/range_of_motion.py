"""Feet stay where the legs can reach."""

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.model import ReducedModel
from quadlab.planners.vertex_zmp.fast.rows import Inequalities, Rows
from quadlab.planners.vertex_zmp.footholds import IntArray


def range_of_motion(model: ReducedModel, margin_m: float) -> Inequalities:
    """Return that every foot is in a box that moves with the CoM, Winkler 2017, Eq. (15), in [m].

    -r < R(psi)^T (p^f[t] - c[t]) - p^f_nom < r, for standing and swinging feet alike.

    Deviations: the box turns with the heading psi(t), which is given; it holds in the middle of the intervals as well,
    for a foot in the air at their quarters too, and is smaller by ``margin_m``, so that feet stay in the whole box
    between the samples. At time 0 there is nothing to decide and no constraint.
    """
    nominal, reach = model.problem.model.nominal_feet, model.problem.model.reach - margin_m
    columns, values, middles, widths = [], [], [], []
    for foot in range(model.footholds.foot_count):
        intervals, fractions = _samples(model, foot)
        times = model.grid.starts_s[intervals] + fractions * model.grid.durations_s[intervals]
        com = model.knot_columns(intervals), -model.spline.weights(intervals, fractions)
        offset = _offset_from_com(model, foot, times, com)
        yaw = model.yaw(times)
        for axis in range(2):
            turned = _component(*offset, yaw, axis)
            columns.append(turned[0])
            values.append(turned[1])
            middles.append(np.full(len(times), nominal[foot, axis]))
            widths.append(np.full(len(times), reach[axis]))
    middle, width = np.concatenate(middles), np.concatenate(widths)
    rows = Rows("range_of_motion_m", np.concatenate(columns), np.concatenate(values), np.zeros(len(middle)))
    return Inequalities(rows, middle - width, middle + width)


def _samples(model: ReducedModel, foot: int) -> tuple[IntArray, Array]:
    """Return (interval, elapsed fraction) of all samples of a foot, both (s,)."""
    every = np.arange(model.grid.count)
    contacts = model.problem.schedule.contacts[model.grid.node_phases[model.grid.nodes[:, 0]], foot]
    swinging = np.flatnonzero(~contacts)
    intervals = np.concatenate([every, every, swinging, swinging])
    return intervals, np.repeat([0.5, 1.0, 0.25, 0.75], [len(every), len(every), len(swinging), len(swinging)])


def _offset_from_com(
    model: ReducedModel, foot: int, times_s: Array, com: tuple[IntArray, Array]
) -> tuple[IntArray, Array]:
    """Return p - c of one foot: columns (s, 6, 2 axes) and values (s, 6)."""
    stances, shares = model.footholds.position_shares(foot, times_s)
    following = np.minimum(stances + 1, model.footholds.count - 1)
    feet = model.columns.stances[np.stack([stances, following], axis=1)]
    values = np.concatenate([com[1], np.stack([1.0 - shares, shares], axis=1)], axis=1)
    return np.concatenate([com[0], feet], axis=1), values


def _component(columns: IntArray, values: Array, yaw: Array, axis: int) -> tuple[IntArray, Array]:
    """Return one component in the heading frame: columns and values, both (s, 12)."""
    cosine, sine = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
    on_x, on_y = (cosine, sine) if axis == 0 else (-sine, cosine)
    return (
        np.concatenate([columns[:, :, 0], columns[:, :, 1]], axis=1),
        np.concatenate([on_x * values, on_y * values], axis=1),
    )
