"""The unknowns and parameters of the program, with the names that its terms use."""

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.footholds import FootholdIndex
from quadlab.planners.vertex_zmp.grid import IntArray, PolynomialGrid
from quadlab.planners.vertex_zmp.layout import BlockLayout
from quadlab.robots.legs import LEG_COUNT

QUARTIC_ORDER = 4
COEFFICIENT_COUNT = QUARTIC_ORDER + 1


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
        loads: load shares lambda at the nodes, CasADi (4, N), w_u of Eq. (18); structurally zero in the air.
        start_com, start_velocity, goal: parameters, CasADi (2, 1).
        waypoints: CoM positions to pass near, parameter, CasADi (2, w).
        sample_directions: cos and sin of the heading at the range-of-motion samples, parameter, CasADi (2, s).
        stance_directions: cos and sin of the heading at the middle of the free stances, CasADi (2, M - 4).
    """

    com: QuarticSpline
    stances: Any
    loads: Any
    start_com: Any
    start_velocity: Any
    goal: Any
    waypoints: Any
    sample_directions: Any
    stance_directions: Any


def variable_layout(grid: PolynomialGrid, footholds: FootholdIndex) -> BlockLayout:
    """Return the blocks of the decision vector w = (w_c, w_p, w_u)."""
    return BlockLayout(
        {
            "com_coefficients": (2 * COEFFICIENT_COUNT, grid.count),
            "footholds": (2, footholds.swing_count),
            "loads": (int(grid.node_contacts.sum()), 1),
        }
    )


def parameter_layout(grid: PolynomialGrid, footholds: FootholdIndex, waypoint_count: int) -> BlockLayout:
    """Return the blocks of what changes from one problem to the next while schedule and robot stay."""
    return BlockLayout(
        {
            "start_com": (2, 1),
            "start_velocity": (2, 1),
            "start_feet": (2, LEG_COUNT),
            "goal": (2, 1),
            "waypoints": (2, waypoint_count),
            "sample_directions": (2, 2 * grid.count),
            "stance_directions": (2, footholds.swing_count),
        }
    )


def make_symbols(
    grid: PolynomialGrid,
    footholds: FootholdIndex,
    layouts: tuple[BlockLayout, BlockLayout],
    vectors: tuple[Any, Any],
) -> Symbols:
    """Return the named views on the symbolic vectors (variables, parameters), given their layouts."""
    (variables, parameters), (x, p) = layouts, vectors
    coefficients = variables.symbol("com_coefficients", x)
    stances = ca.SX(2, footholds.count)
    stances[:, footholds.first.tolist()] = parameters.symbol("start_feet", p)
    stances[:, footholds.free.tolist()] = variables.symbol("footholds", x)
    nodes, legs = np.nonzero(grid.node_contacts)
    contact = ca.Sparsity.triplet(LEG_COUNT, len(grid.node_phases), legs.tolist(), nodes.tolist())
    return Symbols(
        com=QuarticSpline(
            tuple(coefficients[2 * power : 2 * power + 2, :] for power in range(COEFFICIENT_COUNT)), grid.durations_s
        ),
        stances=stances,
        loads=ca.SX(contact, variables.symbol("loads", x)),
        **{name: parameters.symbol(name, p) for name in parameters.shapes if name != "start_feet"},
    )
