"""Footholds near the nominal stance."""

import numpy as np

from quadlab.planners.vertex_zmp.fast.model import ReducedModel
from quadlab.planners.vertex_zmp.fast.rows import Rows, on_both_axes


def nominal_foothold(model: ReducedModel) -> Rows:
    """Return the distance of each foothold from its nominal place at the middle of its stance, in [m].

    J = sum_f sum_s ||p_s^f - c(t_s) - R(psi(t_s)) p_nom^f||^2 with t_s the middle of the stance.
    Addition to Winkler 2017, whose footholds are free within their boxes: over long horizons this keeps steps regular.
    """
    footholds = model.footholds
    intervals, fractions = model.grid.locate(footholds.free_middles_s)
    nominal = footholds.nominal_places(model.problem.model.nominal_feet, model.yaw(footholds.free_middles_s))
    stances = model.columns.stances[footholds.free][:, None, :]
    columns = np.concatenate([model.knot_columns(intervals), stances], axis=1)
    com = -model.spline.weights(intervals, fractions)
    both = on_both_axes(columns, np.concatenate([com, np.ones((len(com), 1))], axis=1))
    return Rows("nominal_foothold", *both, -nominal.ravel())
