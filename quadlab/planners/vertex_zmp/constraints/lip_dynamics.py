"""The linear inverted pendulum."""

from typing import Any

import casadi as ca
import numpy as np

from quadlab.planners.problem import PlanningModel
from quadlab.planners.vertex_zmp.footholds import FootholdIndex
from quadlab.planners.vertex_zmp.grid import PolynomialGrid
from quadlab.planners.vertex_zmp.symbols import Symbols
from quadlab.planners.vertex_zmp.terms import Constraint, equality


def lip_dynamics(symbols: Symbols, grid: PolynomialGrid, footholds: FootholdIndex, model: PlanningModel) -> Constraint:
    """Return the dynamics at the start, middle and end of each polynomial, Winkler 2017, Eq. (12) and Appendix B.

    c_ddot[t] = g / h (c[t] - u[t]) for t in {t_k, t_k + T_k / 2, t_{k+1}}; the paper prints (t_{k+1} - t_k) / 2 for
    the middle. Multiplied by h / g: the residual is an error of the CoP in [m].
    """
    cop = centre_of_pressure(symbols, grid, footholds)
    pieces = np.arange(grid.count)
    height_over_gravity = model.com_height / model.gravity
    errors = []
    for node, fraction in enumerate((0.0, 0.5, 1.0)):
        fractions = np.full(grid.count, fraction)
        com, acceleration = symbols.com.at(pieces, fractions), symbols.com.at(pieces, fractions, 2)
        errors.append(cop[:, grid.nodes[:, node].tolist()] - (com - height_over_gravity * acceleration))
    return equality("lip_dynamics_m", ca.vertcat(*errors))


def centre_of_pressure(symbols: Symbols, grid: PolynomialGrid, footholds: FootholdIndex) -> Any:
    """Return u = sum_f lambda^f p^f at the load nodes, Eq. (17) for point feet; CasADi (2, N) in [m]."""
    stances = footholds.phase_stances[grid.node_phases]
    shape = grid.node_contacts.T.shape
    rows = []
    for axis in range(2):
        positions = symbols.stances[axis, stances.ravel().tolist()].reshape(shape)
        rows.append(ca.sum1(symbols.loads * positions))
    return ca.vertcat(*rows)
