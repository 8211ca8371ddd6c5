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

from quadlab.controllers.hierarchy.factorisation import tail_norm
from quadlab.controllers.hierarchy.multipliers import compute_multipliers, find_leaving
from quadlab.controllers.hierarchy.step import advance, compute_step, factorise_working_set, find_blocking_row
from quadlab.controllers.hierarchy.workspace import FREE, HELD, PULLED, Workspace, bound_of
from quadlab.jit import inlined

SOLVED, ITERATION_LIMIT, BREAKDOWN = 0, 1, 2
BLAND_AFTER = 40  # iterations in a level before the rule that cannot cycle takes over
STATIONARY_STEP = 1e-13  # a step this much smaller than the point is none
LONGEST_STEP = 1e150  # a longer step cannot be squared: numbers have overflowed


@inlined
def hold(workspace: Workspace, row: int, side: int, working_count: int) -> int:
    """Add ``row`` to the working set at its bound on ``side``; return the new size."""
    workspace.roles[row] = HELD * side
    workspace.values[row] = bound_of(side, workspace.lower[row], workspace.upper[row])
    workspace.working[working_count] = row
    return working_count + 1


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
        if not length < LONGEST_STEP:
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
