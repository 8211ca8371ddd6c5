"""Primal active-set method for one level, started from a point that is optimal for all higher levels.

With G the rows in the free coordinates u, the level at hand solves

    min  1/2 sum_{i in level} r_i(u)^2    subject to    l_j <= G_j u <= h_j  for the live rows j of higher levels,

where r_i is the residual of an equality or the violation of an inequality. The objective is convex, continuously
differentiable and piecewise quadratic: it is quadratic as long as the same rows are violated. The method

1. takes the violated rows and the equalities as a least-squares problem,
2. steps towards its solution in the null space of the working set W (rows that are kept exactly at their bound),
3. stops where a row of a higher level reaches its bound, or where a row of this level changes between satisfied and
   violated (a kink of the objective); that row joins W,
4. without such a row, computes the multipliers of W and lets the row go that most disagrees in sign. A row at a kink
   may leave to either side: into the objective if its multiplier points outwards, to the satisfied rows otherwise.

It ends where no multiplier disagrees: these are the Karush-Kuhn-Tucker conditions of a convex problem.
"""

from quadlab.controllers.hierarchy.factorisation import factorise_rows, solve_least_squares, solve_transposed, tail_norm
from quadlab.controllers.hierarchy.jit import inlined
from quadlab.controllers.hierarchy.workspace import (
    ELIMINATED,
    EQUALITY,
    FREE,
    HELD,
    PULLED,
    Workspace,
    bound_of,
    in_objective,
    row_tolerance,
)

SOLVED, ITERATION_LIMIT, BREAKDOWN = 0, 1, 2
BLAND_AFTER = 40  # iterations in a level before the rule that cannot cycle takes over
STATIONARY_STEP = 1e-13  # a step this much smaller than the point is none
PARALLEL_TOLERANCE = 1e-9  # a row whose relative slope along the step is smaller cannot block it
WRONG_SIGN = 1e-9  # relative to the largest residual: a multiplier that disagrees by less is zero
ROUNDING = 1e-12  # relative to the largest bound: rounding error of a multiplier


@inlined
def classify(workspace: Workspace, first: int, last: int) -> bool:
    """Evaluate the rows of a level and give them their roles; return whether there is anything to minimise."""
    rows, point, lowers, uppers = workspace.rows, workspace.point, workspace.lower, workspace.upper
    norms, values, roles = workspace.norms, workspace.values, workspace.roles
    tolerance = row_tolerance(point)
    unfinished = False
    for row in range(first, last):
        value = 0.0
        for column in range(len(point)):
            value += rows[row, column] * point[column]
        lower, upper, slack = lowers[row], uppers[row], tolerance * norms[row]
        role = FREE
        if lower == upper:
            role = EQUALITY
        elif value > upper + slack:
            role = PULLED
        elif value < lower - slack:
            role = -PULLED
        values[row] = value
        roles[row] = role
        unfinished = unfinished or role != FREE
    return unfinished


@inlined
def factorise_working_set(workspace: Workspace, fixed: int, working_count: int) -> int:
    """Factorise the working set, let go of rows that depend on others of it, and return how many stay."""
    rank = factorise_rows(
        workspace.rows,
        workspace.norms,
        workspace.working,
        working_count,
        fixed,
        workspace.basis,
        workspace.triangle,
        workspace.vector,
    )
    for position in range(rank, working_count):
        workspace.roles[workspace.working[position]] = FREE
    return rank


@inlined
def build_system(workspace: Workspace, first: int, last: int, fixed: int, rank: int) -> int:
    """Write the least-squares problem B z = target of the level in the null space Z; return its number of rows."""
    rows, roles, lower, upper = workspace.rows, workspace.roles, workspace.lower, workspace.upper
    basis, system = workspace.basis, workspace.system
    target, system_norms = workspace.target, workspace.system_norms
    values, norms = workspace.values, workspace.norms
    free = rows.shape[1] - fixed
    count = 0
    for row in range(first, last):
        role = roles[row]
        if not in_objective(role):
            continue
        for j in range(free - rank):
            system[count, j] = 0.0
        for i in range(free):
            entry = rows[row, fixed + i]
            for j in range(free - rank):
                system[count, j] += entry * basis[i, rank + j]
        target[count] = bound_of(role, lower[row], upper[row]) - values[row]
        system_norms[count] = norms[row]
        count += 1
    return count


@inlined
def compute_step(workspace: Workspace, first: int, last: int, fixed: int, rank: int) -> float:
    """Compute the shortest step Z z to the minimum of the current quadratic piece; return its length."""
    step, basis, solution = workspace.step, workspace.basis, workspace.solution
    free = len(step) - fixed
    for i in range(free):
        step[i] = 0.0
    if rank == free:
        return 0.0
    count = build_system(workspace, first, last, fixed, rank)
    solve_least_squares(
        workspace.system,
        workspace.system_norms,
        workspace.target,
        count,
        free - rank,
        workspace.factor,
        workspace.vector,
        solution,
    )
    for i in range(free):
        for j in range(free - rank):
            step[i] += basis[i, rank + j] * solution[j]
    return tail_norm(step, 0, free)


@inlined
def find_blocking_row(workspace: Workspace, last: int, fixed: int, length: float) -> tuple[float, int, int]:
    """Return (fraction, row, side): how much of the step is possible, and the row that ends it at which bound.

    Row -1 means that the whole step is possible. Also writes the rates of all live rows.
    """
    rows, roles, norms, rates, step = workspace.rows, workspace.roles, workspace.norms, workspace.rates, workspace.step
    lower, upper, values = workspace.lower, workspace.upper, workspace.values
    free = rows.shape[1] - fixed
    fraction, blocking, side = 1.0, -1, 0
    for row in range(last):
        role = roles[row]
        if role == ELIMINATED:
            continue
        rate = 0.0
        for i in range(free):
            rate += rows[row, fixed + i] * step[i]
        rates[row] = rate
        if role in (EQUALITY, HELD, -HELD) or abs(rate) <= PARALLEL_TOLERANCE * norms[row] * length:
            continue
        direction = 1 if rate > 0.0 else -1
        if role == direction:  # violated and on its way further out
            continue
        crossed = direction if role == FREE else role
        bound = bound_of(crossed, lower[row], upper[row])
        possible = max((bound - values[row]) / rate, 0.0)
        if possible < fraction:
            fraction, blocking, side = possible, row, crossed
    return fraction, blocking, side


@inlined
def advance(workspace: Workspace, last: int, fixed: int, fraction: float) -> None:
    """Move the point by ``fraction`` of the step."""
    point, step, values, rates = workspace.point, workspace.step, workspace.values, workspace.rates
    roles = workspace.roles
    for i in range(len(point) - fixed):
        point[fixed + i] += fraction * step[i]
    for row in range(last):
        if roles[row] != ELIMINATED:
            values[row] += fraction * rates[row]


@inlined
def hold(workspace: Workspace, row: int, side: int, working_count: int) -> int:
    """Add ``row`` to the working set at its bound on ``side``; return the new size."""
    workspace.roles[row] = HELD * side
    workspace.values[row] = bound_of(side, workspace.lower[row], workspace.upper[row])
    workspace.working[working_count] = row
    return working_count + 1


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


@inlined
def release(workspace: Workspace, first: int, leaving: int, working_count: int) -> int:
    """Let the row at position ``leaving`` go to the side its multiplier points to; return the new size."""
    row = workspace.working[leaving]
    side = 1 if workspace.roles[row] > 0 else -1
    pulls_outwards = row >= first and workspace.multipliers[leaving] * side > 0.0
    workspace.roles[row] = PULLED * side if pulls_outwards else FREE
    for position in range(leaving, working_count - 1):
        workspace.working[position] = workspace.working[position + 1]
    return working_count - 1


@inlined
def solve_level(
    workspace: Workspace, first: int, last: int, fixed: int, working_count: int, iterations: int
) -> tuple[int, int, int]:
    """Minimise the level in rows[first:last] without touching higher ones.

    Args:
        workspace: memory; the point is optimal for the rows before ``first``.
        first, last: rows of the level.
        fixed: number of coordinates that are not free.
        working_count: size of the working set left by higher levels.
        iterations: how many iterations may still be made.

    Returns:
        (size of the working set, iterations made, SOLVED or ITERATION_LIMIT or BREAKDOWN).
    """
    made = 0
    while made < iterations:
        made += 1
        working_count = factorise_working_set(workspace, fixed, working_count)
        length = compute_step(workspace, first, last, fixed, working_count)
        if not length < 1e300:
            return working_count, made, BREAKDOWN
        if length > STATIONARY_STEP * (1.0 + tail_norm(workspace.point, 0, len(workspace.point))):
            fraction, blocking, side = find_blocking_row(workspace, last, fixed, length)
            advance(workspace, last, fixed, fraction)
            if blocking >= 0:
                working_count = hold(workspace, blocking, side, working_count)
                continue
        if working_count == 0:
            return 0, made, SOLVED
        compute_multipliers(workspace, first, last, fixed, working_count)
        leaving = find_leaving(workspace, first, last, working_count, made > BLAND_AFTER)
        if leaving < 0:
            return working_count, made, SOLVED
        working_count = release(workspace, first, leaving, working_count)
    return working_count, made, ITERATION_LIMIT
