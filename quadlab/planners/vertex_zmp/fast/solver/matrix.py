"""The matrix of an interior-point step and its factors."""

from typing import NamedTuple

from quadlab.geometry.rotations import Array
from quadlab.planners.vertex_zmp.fast.solver.factor import factorise
from quadlab.planners.vertex_zmp.fast.solver.jit import compiled
from quadlab.planners.vertex_zmp.fast.solver.kkt import KktPlan
from quadlab.planners.vertex_zmp.fast.solver.numbers import ProgramArrays
from quadlab.planners.vertex_zmp.fast.solver.state import Iterate, Residuals, Settings
from quadlab.planners.vertex_zmp.footholds import IntArray

_REGULARISATION = 1e-9  # keeps pivots of the equalities away from 0; a step solves them that much less exactly


class Workspace(NamedTuple):
    """Memory of the linear algebra.

    Attributes:
        k_values, l_values, inverse_pivots: the matrix and its factors.
        row, filled: work space of the factorisation.
        permuted: right-hand side in the order of elimination, (n + e,).
        e_lower, e_upper: what complementarity asks for, (i,).
        pair_products: products of the pairs of entries of each row of G.
    """

    k_values: Array
    l_values: Array
    inverse_pivots: Array
    row: Array
    filled: IntArray
    permuted: Array
    e_lower: Array
    e_upper: Array
    pair_products: Array


@compiled
def factorise_kkt(
    program: ProgramArrays,
    plan: KktPlan,
    at: Iterate,
    found: Residuals,
    proximal: float,
    settings: Settings,
    work: Workspace,
) -> int:
    """Factorise the matrix of the Newton step; return how often that took.

    The curvature of the products is left out where it would not leave exactly one negative pivot an equality.
    """
    with_curvature = settings.curvature
    for count in range(1, 3):
        _assemble(program, plan, at, found, proximal, settings.elastic, work.k_values, work.pair_products)
        if with_curvature:
            for p in range(len(program.p_rows)):
                work.k_values[plan.from_products[p]] += program.p_coefficients[p] * at.y[program.p_rows[p]]
        negative = factorise(plan.elimination, work.k_values, work.l_values, work.inverse_pivots, work.row, work.filled)
        if not with_curvature or negative == len(at.y):
            return count
        with_curvature = False
    return 2


@compiled
def _assemble(
    program: ProgramArrays,
    plan: KktPlan,
    at: Iterate,
    found: Residuals,
    proximal: float,
    elastic: float,
    k_values: Array,
    pair_products: Array,
) -> None:
    """Write [H + proximal + G' D G, J'; J, -regularisation] to ``k_values``."""
    size = len(at.z)
    for entry in range(len(k_values)):
        k_values[entry] = 0.0
    for index in range(len(plan.diagonal)):
        k_values[plan.diagonal[index]] = proximal if index < size else -(elastic + _REGULARISATION)
    for entry in range(len(plan.from_h)):
        if plan.from_h[entry] >= 0:
            k_values[plan.from_h[entry]] += program.h_values[entry]
    for entry in range(len(plan.from_a)):
        k_values[plan.from_a[entry]] += found.jacobian[entry]
    for row in range(len(at.t_lower)):
        stiffness = at.w_lower[row] / (at.t_lower[row] + elastic * at.w_lower[row])
        stiffness += at.w_upper[row] / (at.t_upper[row] + elastic * at.w_upper[row])
        for pair in range(plan.pair_begins[row], plan.pair_begins[row + 1]):
            k_values[plan.pair_places[pair]] += stiffness * pair_products[pair]
