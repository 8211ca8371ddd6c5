"""Lagrange multipliers of the working set: which held row has to go."""

from quadlab.controllers.hierarchy.factorisation import solve_transposed
from quadlab.controllers.hierarchy.workspace import Workspace, bound_of, in_objective
from quadlab.jit import inlined

WRONG_SIGN = 1e-9  # relative to the largest residual: a multiplier that disagrees by less is zero
ROUNDING = 1e-12  # relative to the largest bound: rounding error of a multiplier


@inlined
def compute_multipliers(workspace: Workspace, first: int, last: int, fixed: int, rank: int) -> None:
    """Solve  G_W^T multipliers = -gradient  with G_W = T Y^T, so  T^T multipliers = -Y^T gradient."""
    rows, basis, gradient, multipliers = workspace.rows, workspace.basis, workspace.vector, workspace.multipliers
    roles, values, lower, upper = workspace.roles, workspace.values, workspace.lower, workspace.upper
    free = rows.shape[1] - fixed
    for i in range(free):
        gradient[i] = 0.0
    for row in range(first, last):
        if in_objective(roles[row]):
            residual = values[row] - bound_of(roles[row], lower[row], upper[row])
            for i in range(free):
                gradient[i] += residual * rows[row, fixed + i]
    for j in range(rank):
        multipliers[j] = 0.0
    for i in range(free):
        for j in range(rank):
            multipliers[j] -= gradient[i] * basis[i, j]
    solve_transposed(workspace.triangle, rank, multipliers)


@inlined
def gradient_scales(workspace: Workspace, first: int, last: int) -> tuple[float, float]:
    """Return the largest contribution of a row to the gradient, and the same with its bound for the residual."""
    roles, values, norms = workspace.roles, workspace.values, workspace.norms
    lower, upper = workspace.lower, workspace.upper
    largest_residual, largest_bound = 0.0, 0.0
    for row in range(first, last):
        if in_objective(roles[row]):
            bound, norm = bound_of(roles[row], lower[row], upper[row]), norms[row]
            largest_residual = max(largest_residual, abs(values[row] - bound) * norm)
            largest_bound = max(largest_bound, (abs(bound) + norm) * norm)
    return largest_residual, largest_bound


@inlined
def find_leaving(workspace: Workspace, first: int, last: int, rank: int, bland: bool) -> int:
    """Return the position in the working set of the row to let go, -1 if every multiplier has the right sign.

    A row held at its upper bound needs a multiplier >= 0, at its lower bound <= 0, and a row at a kink needs 0.
    """
    roles, norms, working, multipliers = workspace.roles, workspace.norms, workspace.working, workspace.multipliers
    largest_residual, largest_bound = gradient_scales(workspace, first, last)
    worst = WRONG_SIGN * largest_residual + ROUNDING * largest_bound
    leaving = -1
    for position in range(rank):
        row = working[position]
        outward = multipliers[position] * norms[row]
        if roles[row] < 0:
            outward = -outward
        wrong = abs(outward) if row >= first else -outward
        if wrong <= worst:
            continue
        if not bland:
            worst, leaving = wrong, position
        elif leaving < 0 or row < working[leaving]:
            leaving = position
    return leaving
