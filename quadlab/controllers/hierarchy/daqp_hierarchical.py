"""DAQP's own hierarchical mode: a third opinion beside the lexicographic solver and the cascade.

It has traps that are seen to here: it normalises rows, so all rows of a level get one norm by a variable that is fixed
at zero; empty levels are left out. A row that higher levels imply still takes a degree of freedom from lower ones,
mostly without a word: its answers have to be judged by the ``certificate``.
"""

from collections.abc import Sequence

import daqp
import numpy as np

from quadlab.controllers.hierarchy.level import Level, stack
from quadlab.geometry.rotations import Array

_OPEN = 1e30  # DAQP's infinity
_EQUALITY = 5
_SOFTENING = 1e-6
_FEASIBILITY = 1e-8
_SOLVED = (1, 2)  # exit flags: optimal, optimal with slacks


def solve_daqp_hierarchical(levels: Sequence[Level]) -> tuple[Array, bool]:
    """Return x (n,) and whether DAQP says that it solved the hierarchy; NaN if it gives no numbers.

    Args:
        levels: highest priority first.
    """
    stacked = stack(levels)
    sizes = np.diff(stacked.breaks)
    count, dimension = stacked.matrix.shape
    matrix = np.zeros((count, dimension + 1))
    matrix[:, 1:] = stacked.matrix
    norms = np.linalg.norm(stacked.matrix, axis=1)
    for first, last in zip(stacked.breaks[:-1], stacked.breaks[1:], strict=True):
        if first < last:
            missing = norms[first:last].max() ** 2 - norms[first:last] ** 2
            matrix[first:last, 0] = np.sqrt(np.maximum(missing, 0.0))  # rounding
    upper = np.concatenate([[0.0], np.clip(stacked.upper, -_OPEN, _OPEN)])
    lower = np.concatenate([[0.0], np.clip(stacked.lower, -_OPEN, _OPEN)])
    x, _, flag, _ = daqp.solve(
        None,
        None,
        matrix,
        upper,
        lower,
        np.where(upper == lower, _EQUALITY, 0).astype(np.int32),
        break_points=(1 + stacked.breaks[1:][sizes > 0]).astype(np.int32),
        rho_soft=_SOFTENING,
        primal_tol=_FEASIBILITY,
    )
    return np.asarray(x, dtype=np.float64)[1:], int(flag) in _SOLVED
