"""The linear inverted pendulum."""

from typing import Any

import casadi as ca
import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.problem import PlanningModel
from quadlab.planners.vertex_zmp.footholds import FootholdIndex
from quadlab.planners.vertex_zmp.grid import TimeGrid
from quadlab.planners.vertex_zmp.paper.symbols import Symbols
from quadlab.planners.vertex_zmp.paper.terms import Constraint, equality


def lip_dynamics(symbols: Symbols, grid: TimeGrid, footholds: FootholdIndex, model: PlanningModel) -> Constraint:
    """Return the dynamics at the start, middle and end of each polynomial, Winkler 2017, Eq. (12) and Appendix B.

    c_ddot[t] = g / h (c[t] - u[t]) for t in {t_k, t_k + T_k / 2, t_{k+1}}; the paper prints (t_{k+1} - t_k) / 2 for
    the middle. Multiplied by h / g: the residual is an error of the CoP in [m].
    """
    cop = centre_of_pressure(symbols, grid, footholds, model.foot_vertices)
    pieces = np.arange(grid.count)
    height_over_gravity = model.com_height / model.gravity
    errors = []
    for node, fraction in enumerate((0.0, 0.5, 1.0)):
        fractions = np.full(grid.count, fraction)
        com, acceleration = symbols.com.at(pieces, fractions), symbols.com.at(pieces, fractions, 2)
        errors.append(cop[:, grid.nodes[:, node].tolist()] - (com - height_over_gravity * acceleration))
    return equality("lip_dynamics_m", ca.vertcat(*errors))


def centre_of_pressure(symbols: Symbols, grid: TimeGrid, footholds: FootholdIndex, vertices: Array) -> Any:
    """Return the CoP at the load nodes, CasADi (2, N) in [m].

    u = sum_f sum_v lambda_v^f (p^f + R(alpha^f) v_v), Eq. (17), with the vertices v_v (V, 2) in the frame of the foot.
    """
    stances = footholds.phase_stances[grid.node_phases].ravel().tolist()
    shape = grid.node_contacts.T.shape
    cosine, sine = (function(symbols.yaws)[stances].reshape(shape) for function in (ca.cos, ca.sin))
    feet = [symbols.stances[axis, stances].reshape(shape) for axis in range(2)]
    rows = [ca.SX(1, shape[1]), ca.SX(1, shape[1])]
    for number, (forward, left) in enumerate(vertices):
        loads = symbols.loads[number :: len(vertices), :]
        rows[0] += ca.sum1(loads * (feet[0] + cosine * forward - sine * left))
        rows[1] += ca.sum1(loads * (feet[1] + sine * forward + cosine * left))
    return ca.vertcat(*rows)
