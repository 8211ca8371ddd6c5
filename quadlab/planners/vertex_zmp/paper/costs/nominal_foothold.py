"""Footholds near the nominal stance."""

import casadi as ca

from quadlab.planners.problem import PlanningModel
from quadlab.planners.vertex_zmp.footholds import FootholdIndex
from quadlab.planners.vertex_zmp.grid import TimeGrid
from quadlab.planners.vertex_zmp.paper.symbols import Symbols
from quadlab.planners.vertex_zmp.paper.terms import Cost


def nominal_foothold(
    symbols: Symbols, grid: TimeGrid, footholds: FootholdIndex, model: PlanningModel, weight: float
) -> Cost:
    """Return the distance of each foothold from its nominal place at the middle of its stance, in [m^2].

    J = sum_f sum_s ||p_s^f - c(t_s) - R(psi(t_s)) p_nom^f||^2 with t_s the middle of the stance.

    Addition to Winkler 2017, whose footholds are free within their boxes: over long horizons this keeps steps regular.
    """
    pieces, fractions = grid.locate(footholds.free_middles_s)
    nominal = ca.DM(model.nominal_feet[footholds.free_legs].T)
    cosine, sine = symbols.stance_directions[0, :], symbols.stance_directions[1, :]
    turned = ca.vertcat(
        cosine * nominal[0, :] - sine * nominal[1, :],
        sine * nominal[0, :] + cosine * nominal[1, :],
    )
    offset = symbols.stances[:, footholds.free.tolist()] - symbols.com.at(pieces, fractions) - turned
    return Cost("nominal_foothold", weight, ca.sumsqr(offset))
