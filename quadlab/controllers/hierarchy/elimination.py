"""What a solved level leaves to the levels below: equalities are eliminated, satisfied inequalities stay.

The optimum of a level fixes more than its equalities. The vector of residuals and violations is unique, so violated
rows are equalities for every lower level (their slack is frozen, Bellicoso 2016, Eq. (9)); and complementarity keeps
every row of a higher level whose multiplier is positive at its bound. Both are eliminated here like the equalities
in the iterative null space of Eq. (12). Deviation from the paper: Eq. (9) keeps them as inequalities, which leaves a
feasible set without interior.
"""

import math

from quadlab.controllers.hierarchy.factorisation import RANK_TOLERANCE, make_reflector, reflect
from quadlab.controllers.hierarchy.multipliers import gradient_scales
from quadlab.controllers.hierarchy.workspace import (
    ELIMINATED,
    EQUALITY,
    FREE,
    Workspace,
    bound_of,
    in_objective,
    row_tolerance,
)
from quadlab.jit import inlined

POSITIVE_MULTIPLIER = 1e-7  # relative to the largest residual: a larger multiplier holds its row for good
ROUNDING = 1e-10  # relative to the largest bound: rounding error of such a multiplier
VIOLATED = 10.0  # times the row tolerance: a row that misses its bound by less counts as satisfied


@inlined
def select_held_rows(workspace: Workspace, first: int, last: int, working_count: int) -> tuple[int, int]:
    """Move rows of higher levels with a positive multiplier from the working set to the candidates.

    Returns:
        (number of candidates, size of the working set).
    """
    roles, norms, working, multipliers = workspace.roles, workspace.norms, workspace.working, workspace.multipliers
    largest_residual, largest_bound = gradient_scales(workspace, first, last)
    threshold = POSITIVE_MULTIPLIER * largest_residual + ROUNDING * largest_bound
    selected, kept = 0, 0
    for position in range(working_count):
        row = working[position]
        outward = multipliers[position] * norms[row]
        if roles[row] < 0:
            outward = -outward
        if row < first and outward > threshold:
            workspace.candidates[selected] = row
            selected += 1
        else:
            working[kept] = row
            kept += 1
    return selected, kept


@inlined
def select_own_rows(workspace: Workspace, first: int, last: int, selected: int) -> int:
    """Add equalities and violated rows of the level to the candidates; return their number.

    A violated row that ends at its bound becomes an ordinary inequality; its bound moves by the rounding error.
    """
    roles, norms, lower, upper = workspace.roles, workspace.norms, workspace.lower, workspace.upper
    tolerance = VIOLATED * row_tolerance(workspace.point)
    for row in range(first, last):
        role, value = roles[row], workspace.values[row]
        if not in_objective(role):
            continue
        violation = abs(value - bound_of(role, lower[row], upper[row]))
        if role == EQUALITY or violation > tolerance * norms[row]:
            workspace.candidates[selected] = row
            selected += 1
            continue
        if role > 0:
            upper[row] = max(upper[row], value)
        else:
            lower[row] = min(lower[row], value)
        roles[row] = FREE
    return selected


@inlined
def take_most_independent(workspace: Workspace, selected: int, fixed: int) -> tuple[int, float]:
    """Return (row, rest): the candidate that keeps the largest share of its norm in the free coordinates, or -1.

    Candidates that keep none are taken off (-1); the others still wait for their turn.
    """
    rows, norms, candidates = workspace.rows, workspace.norms, workspace.candidates
    best, best_share, best_rest = -1, 0.0, 0.0
    for position in range(selected):
        row = candidates[position]
        if row < 0:
            continue
        square = 0.0
        for column in range(fixed, rows.shape[1]):
            square += rows[row, column] * rows[row, column]
        rest = math.sqrt(square)
        if rest <= RANK_TOLERANCE * norms[row]:
            candidates[position] = -1
        elif rest > best_share * norms[row]:
            best, best_share, best_rest = position, rest / norms[row], rest
    if best < 0:
        return -1, 0.0
    row = candidates[best]
    candidates[best] = -1
    return row, best_rest


@inlined
def eliminate(workspace: Workspace, row: int, rest: float, count: int, fixed: int) -> None:
    """Rotate the free coordinates so that ``row`` depends on the first of them only, which is thereby used up."""
    rows, roles = workspace.rows, workspace.roles
    dimension = rows.shape[1]
    reflector = workspace.reflectors[fixed]
    for column in range(fixed, dimension):
        reflector[column] = rows[row, column]
    _, scale = make_reflector(reflector, fixed, rest)
    workspace.reflector_scales[fixed] = scale
    for other in range(count):
        if roles[other] == ELIMINATED:
            continue
        product = 0.0
        for column in range(fixed, dimension):
            product += rows[other, column] * reflector[column]
        product *= scale
        for column in range(fixed, dimension):
            rows[other, column] -= product * reflector[column]
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
