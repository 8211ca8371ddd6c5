"""Feet stay where the legs can reach."""

import casadi as ca
import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.problem import PlanningModel
from quadlab.planners.vertex_zmp.footholds import FootholdIndex
from quadlab.planners.vertex_zmp.grid import TimeGrid
from quadlab.planners.vertex_zmp.paper.symbols import Symbols
from quadlab.planners.vertex_zmp.paper.terms import Constraint, interval


def range_of_motion(
    symbols: Symbols, grid: TimeGrid, footholds: FootholdIndex, model: PlanningModel, margin_m: float
) -> Constraint:
    """Return that every foot is in a box that moves with the CoM, Winkler 2017, Eq. (15), in [m].

    -r < R(psi)^T (p^f[t] - c[t]) - p^f_nom < r, for standing and swinging feet alike.

    Deviations: the box turns with the heading psi(t), which is given; it holds at the middles of the polynomials as
    well and is smaller by ``margin_m``, so that feet stay in the whole box between the samples. At time 0 there is
    nothing to decide and no constraint.
    """
    times = range_of_motion_times(grid)
    pieces, fractions = grid.locate(times)
    com = symbols.com.at(pieces, fractions)
    cosine, sine = symbols.sample_directions[0, :], symbols.sample_directions[1, :]
    offsets = []
    for leg in range(footholds.foot_count):
        relative = symbols.stances @ _position_weights(footholds, leg, times) - com
        offsets += [cosine * relative[0, :] + sine * relative[1, :], cosine * relative[1, :] - sine * relative[0, :]]
    reach = np.tile(model.reach - margin_m, footholds.foot_count)
    nominal = model.nominal_feet.ravel()
    return interval("range_of_motion_m", ca.vertcat(*offsets), nominal - reach, nominal + reach)


def range_of_motion_times(grid: TimeGrid) -> Array:
    """Return when the box is enforced: middle and end of each polynomial, (2 n,) in [s]."""
    return np.stack([grid.starts_s + 0.5 * grid.durations_s, grid.knots_s[1:]], axis=1).ravel()


def _position_weights(footholds: FootholdIndex, leg: int, times_s: Array) -> ca.DM:
    """Return W with foot positions = stances (2, M) @ W at ``times_s``; sparse, (M, s)."""
    stances, shares = footholds.position_shares(leg, times_s)
    samples = np.arange(len(times_s))
    moving = shares > 0.0
    rows = np.concatenate([stances, stances[moving] + 1])
    columns = np.concatenate([samples, samples[moving]])
    weights = np.concatenate([1.0 - shares, shares[moving]])
    return ca.DM.triplet(rows.tolist(), columns.tolist(), ca.DM(weights), footholds.count, len(times_s))
