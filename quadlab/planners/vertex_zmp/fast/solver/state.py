"""What the interior-point method carries from one iteration to the next."""

from typing import NamedTuple

from quadlab.geometry.rotations import Array


class Iterate(NamedTuple):
    """Primal and dual variables; t_l = G z - lower and t_u = upper - G z hold at the solution.

    Attributes:
        z: unknowns, (n,).
        y: multipliers of the equalities, (e,).
        t_lower, t_upper: positive slacks of the inequalities, (i,).
        w_lower, w_upper: their multipliers, (i,); 0 where there is no bound.
    """

    z: Array
    y: Array
    t_lower: Array
    w_lower: Array
    t_upper: Array
    w_upper: Array


class Residuals(NamedTuple):
    """How far the iterate is from satisfying each condition of optimality.

    Attributes:
        equality: A z + products - b - elastic y, (e,).
        dual: gradient of the Lagrangian, (n,).
        lower, upper: t - distance to the bound - elastic w, (i,).
        values: G z, (i,).
        jacobian: values of the Jacobian of the equalities, in the places of A.
    """

    equality: Array
    dual: Array
    lower: Array
    upper: Array
    values: Array
    jacobian: Array


class Settings(NamedTuple):
    """Numbers that steer the method.

    Attributes:
        max_iterations: limit.
        tolerance: largest violation of a constraint and largest complementarity.
        dual_tolerance: largest component of the gradient of the Lagrangian.
        barrier: first complementarity.
        proximal: curvature that is added to every unknown; it shortens steps and does not move the solution.
        polish: the same once the cost has settled.
        curvature: whether the curvature of the products is used where it keeps the step a descent direction.
        elastic: 0, or the compliance of all constraints: they become the cost sum(violation^2) / (2 elastic).
        feasible_is_enough: whether to stop at the first point that satisfies all constraints.
        largest_growth: violation of the equalities that a step may cause in any case.
    """

    max_iterations: int
    tolerance: float
    dual_tolerance: float
    barrier: float
    proximal: float
    polish: float
    curvature: bool
    elastic: float
    feasible_is_enough: bool
    largest_growth: float
