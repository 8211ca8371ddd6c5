"""Feet that point where the robot is heading."""

import casadi as ca

from quadlab.planners.vertex_zmp.footholds import FootholdIndex
from quadlab.planners.vertex_zmp.paper.symbols import Symbols
from quadlab.planners.vertex_zmp.paper.terms import Cost


def foot_yaw(symbols: Symbols, footholds: FootholdIndex, weight: float) -> Cost:
    """Return the misalignment of each free stance with the heading psi at its middle, no unit.

    J = sum_s 1 - cos(alpha_s - psi(t_s)), about half the square of the angle; a constant for point feet.

    Addition to Winkler 2017, where nothing decides the yaw of a foot that leaves the CoP room enough.
    """
    yaws = symbols.yaws[footholds.free.tolist()]
    aligned = ca.cos(yaws) * symbols.stance_directions[0, :] + ca.sin(yaws) * symbols.stance_directions[1, :]
    return Cost("foot_yaw", weight, ca.sum2(1.0 - aligned))
