"""What a solved level leaves to the levels below: equalities are eliminated, satisfied inequalities stay.

The optimum of a level fixes more than its equalities. The vector of residuals and violations is unique, so violated
rows are equalities for every lower level (their slack is frozen, Bellicoso 2016, Eq. (9)); and complementarity keeps
every row of a higher level whose multiplier is positive at its bound. Both are eliminated here like the equalities
in the iterative null space of Eq. (12). Deviation from the paper: Eq. (9) keeps them as inequalities, which leaves a
feasible set without interior.
"""

from quadlab.controllers.hierarchy.active_set import gradient_scales
from quadlab.controllers.hierarchy.factorisation import RANK_TOLERANCE, make_reflector, reflect, tail_norm
from quadlab.controllers.hierarchy.jit import inlined
from quadlab.controllers.hierarchy.workspace import (
    ELIMINATED,
    EQUALITY,
    FREE,
    Workspace,
    bound_of,
    in_objective,
    row_tolerance,
)

POSITIVE_MULTIPLIER = 1e-7  # relative to the largest residual: a larger multiplier holds its row for good
ROUNDING = 1e-10  # relative to the largest bound: rounding error of such a multiplier
VIOLATED = 10.0  # times the row tolerance: a row that misses its bound by less counts as satisfied


@inlined
def select_held_rows(workspace: Workspace, first: int, last: int, working_count: int) -> tuple[int, int]:
    """Move rows of higher levels with a positive multiplier from the working set to the candidates.

    Returns:
        (number of candidates, size of the working set).
    """
    largest_residual, largest_bound = gradient_scales(workspace, first, last)
    threshold = POSITIVE_MULTIPLIER * largest_residual + ROUNDING * largest_bound
    selected, kept = 0, 0
    for position in range(working_count):
        row = workspace.working[position]
        outward = workspace.multipliers[position] * workspace.norms[row]
        if workspace.roles[row] < 0:
            outward = -outward
        if row < first and outward > threshold:
            workspace.candidates[selected] = row
            selected += 1
        else:
            workspace.working[kept] = row
            kept += 1
    return selected, kept


@inlined
def select_own_rows(workspace: Workspace, first: int, last: int, selected: int) -> int:
    """Add equalities and violated rows of the level to the candidates; return their number.

    A violated row that ends at its bound becomes an ordinary inequality; its bound moves by the rounding error.
    """
    tolerance = VIOLATED * row_tolerance(workspace.point)
    for row in range(first, last):
        role, value = workspace.roles[row], workspace.values[row]
        if not in_objective(role):
            continue
        if role == EQUALITY or abs(value - bound_of(workspace, row)) > tolerance * workspace.norms[row]:
            workspace.candidates[selected] = row
            selected += 1
            continue
        if role > 0:
            workspace.upper[row] = max(workspace.upper[row], value)
        else:
            workspace.lower[row] = min(workspace.lower[row], value)
        workspace.roles[row] = FREE
    return selected


@inlined
def take_most_independent(workspace: Workspace, selected: int, fixed: int) -> tuple[int, float]:
    """Return (row, rest): the candidate that keeps the largest share of its norm in the free coordinates, or -1.

    Candidates that keep none are taken off (-1); the others still wait for their turn.
    """
    dimension = len(workspace.point)
    best, best_share, best_rest = -1, 0.0, 0.0
    for position in range(selected):
        row = workspace.candidates[position]
        if row < 0:
            continue
        rest = tail_norm(workspace.rows[row], fixed, dimension)
        if rest <= RANK_TOLERANCE * workspace.norms[row]:
            workspace.candidates[position] = -1
        elif rest > best_share * workspace.norms[row]:
            best, best_share, best_rest = position, rest / workspace.norms[row], rest
    if best < 0:
        return -1, 0.0
    row = workspace.candidates[best]
    workspace.candidates[best] = -1
    return row, best_rest


@inlined
def eliminate(workspace: Workspace, row: int, rest: float, count: int, fixed: int) -> None:
    """Rotate the free coordinates so that ``row`` depends on the first of them only, which is thereby used up."""
    dimension = len(workspace.point)
    reflector = workspace.reflectors[fixed]
    for column in range(fixed, dimension):
        reflector[column] = workspace.rows[row, column]
    _, scale = make_reflector(reflector, fixed, rest)
    workspace.reflector_scales[fixed] = scale
    for other in range(count):
        if workspace.roles[other] != ELIMINATED:
            reflect(workspace.rows[other], reflector, scale, fixed, dimension)
    reflect(workspace.point, reflector, scale, fixed, dimension)
    reflect(workspace.anchor, reflector, scale, fixed, dimension)


@inlined
def freeze_level(
    workspace: Workspace, first: int, last: int, count: int, fixed: int, working_count: int
) -> tuple[int, int]:
    """Eliminate everything that the optimum of the level in rows[first:last] decides.

    Args:
        workspace: memory, at the optimum of the level, with the multipliers of its working set.
        first, last: rows of the level.
        count: number of rows of the hierarchy.
        fixed: number of coordinates that are not free.
        working_count: size of the working set.

    Returns:
        (new number of fixed coordinates, new size of the working set).
    """
    selected, working_count = select_held_rows(workspace, first, last, working_count)
    selected = select_own_rows(workspace, first, last, selected)
    dimension = len(workspace.point)
    waiting = workspace.candidates[:selected].copy()
    while fixed < dimension:
        row, rest = take_most_independent(workspace, selected, fixed)
        if row < 0:
            break
        eliminate(workspace, row, rest, count, fixed)
        workspace.roles[row] = ELIMINATED
        fixed += 1
    for row in waiting:
        workspace.roles[row] = ELIMINATED
    return fixed, working_count
