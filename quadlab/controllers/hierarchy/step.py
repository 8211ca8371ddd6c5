"""One step of the active-set method: to the minimum of the current quadratic piece, or up to the first blocking row."""

from quadlab.controllers.hierarchy.factorisation import factorise_rows, tail_norm
from quadlab.controllers.hierarchy.least_squares import solve_least_squares
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
from quadlab.jit import inlined

PARALLEL_TOLERANCE = 1e-9  # a row whose relative slope along the step is smaller cannot block it


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
