"""The unknowns and parameters of the program, with the names that its terms use."""

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.footholds import FootholdIndex, IntArray
from quadlab.planners.vertex_zmp.grid import TimeGrid
from quadlab.planners.vertex_zmp.paper.layout import BlockLayout

QUARTIC_ORDER = 4
COEFFICIENT_COUNT = QUARTIC_ORDER + 1
_NAMED_PARAMETERS = ("start_com", "start_velocity", "goal", "waypoints", "sample_directions", "stance_directions")


@dataclass(frozen=True)
class QuarticSpline:
    """CoM motion, Winkler 2017, Eq. (8)-(9): c(t) = sum_i b_{k,i} s^i with s = (t - t_k) / T_k.

    Deviation: coefficients are scaled, b_{k,i} = a_{k,i} T_k^i, so that all of them are lengths in [m].

    Attributes:
        coefficients: CasADi (2, n) for each power i = 0..4.
        durations_s: T_k, (n,) in [s].
    """

    coefficients: tuple[Any, ...]
    durations_s: Array

    def at(self, pieces: IntArray, fractions: Array, derivative: int = 0) -> Any:
        """Return the CoM (or a time derivative) at elapsed ``fractions`` of ``pieces``, both (s,); CasADi (2, s)."""
        columns = pieces.tolist()
        total = ca.SX(2, len(columns))
        for power in range(derivative, COEFFICIENT_COUNT):
            factor = float(np.prod(np.arange(power - derivative + 1, power + 1)))
            scale = factor * fractions ** (power - derivative) / self.durations_s[pieces] ** derivative
            total += self.coefficients[power][:, columns] * ca.DM(np.tile(scale, (2, 1)))
        return total


@dataclass(frozen=True)
class Symbols:
    """Everything that a term may refer to.

    Attributes:
        com: CoM spline, w_c of Eq. (9).
        stances: positions on the ground of all stances, CasADi (2, M): the given start and w_p of Eq. (14).
        yaws: yaw alpha of the foot in all stances in [rad], CasADi (1, M); variables only for feet that are no points.
        loads: load shares lambda of all vertices of all feet at the nodes, CasADi (F V, N), vertices of a foot one
            after the other, w_u of Eq. (18); structurally zero in the air.
        start_com, start_velocity, goal: parameters, CasADi (2, 1).
        waypoints: CoM positions to pass near, parameter, CasADi (2, w).
        sample_directions: cos and sin of the heading at the range-of-motion samples, parameter, CasADi (2, s).
        stance_directions: cos and sin of the heading at the middle of the free stances, CasADi (2, M - F).
    """

    com: QuarticSpline
    stances: Any
    yaws: Any
    loads: Any
    start_com: Any
    start_velocity: Any
    goal: Any
    waypoints: Any
    sample_directions: Any
    stance_directions: Any


def vertex_contacts(grid: TimeGrid, vertices: int) -> BoolArray:
    """Return which vertices of feet may carry load at each node, (N, F V)."""
    return np.repeat(grid.node_contacts, vertices, axis=1)


def variable_layout(grid: TimeGrid, footholds: FootholdIndex, vertices: int) -> BlockLayout:
    """Return the blocks of the decision vector w = (w_c, w_p, w_u) for feet with so many vertices."""
    return BlockLayout(
        {
            "com_coefficients": (2 * COEFFICIENT_COUNT, grid.count),
            "footholds": (2, footholds.swing_count),
            "foot_yaws": (1, footholds.swing_count if vertices > 1 else 0),
            "loads": (int(vertex_contacts(grid, vertices).sum()), 1),
        }
    )


def parameter_layout(grid: TimeGrid, footholds: FootholdIndex, waypoint_count: int) -> BlockLayout:
    """Return the blocks of what changes from one problem to the next while schedule and robot stay."""
    return BlockLayout(
        {
            "start_com": (2, 1),
            "start_velocity": (2, 1),
            "start_feet": (2, footholds.foot_count),
            "start_yaw": (1, 1),
            "goal": (2, 1),
            "waypoints": (2, waypoint_count),
            "sample_directions": (2, 2 * grid.count),
            "stance_directions": (2, footholds.swing_count),
        }
    )


def make_symbols(
    grid: TimeGrid,
    footholds: FootholdIndex,
    vertices: int,
    layouts: tuple[BlockLayout, BlockLayout],
    vectors: tuple[Any, Any],
) -> Symbols:
    """Return the named views on the symbolic vectors (variables, parameters), given their layouts."""
    (variables, parameters), (x, p) = layouts, vectors
    coefficients = variables.symbol("com_coefficients", x)
    stances = ca.SX(2, footholds.count)
    stances[:, footholds.first.tolist()] = parameters.symbol("start_feet", p)
    stances[:, footholds.free.tolist()] = variables.symbol("footholds", x)
    yaws = ca.repmat(parameters.symbol("start_yaw", p), 1, footholds.count)
    if vertices > 1:
        yaws[footholds.free.tolist()] = variables.symbol("foot_yaws", x)
    contacts = vertex_contacts(grid, vertices)
    nodes, corners = np.nonzero(contacts)
    contact = ca.Sparsity.triplet(contacts.shape[1], len(contacts), corners.tolist(), nodes.tolist())
    return Symbols(
        com=QuarticSpline(
            tuple(coefficients[2 * power : 2 * power + 2, :] for power in range(COEFFICIENT_COUNT)), grid.durations_s
        ),
        stances=stances,
        yaws=yaws,
        loads=ca.SX(contact, variables.symbol("loads", x)),
        **{name: parameters.symbol(name, p) for name in _NAMED_PARAMETERS},
    )
