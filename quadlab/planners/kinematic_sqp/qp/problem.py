"""The quadratic program of one step, what a solver of it can do, and how its answer is judged."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.sparse import csc_array

from quadlab.geometry.rotations import Array

_OPEN_BOUND = 1e3
"""Where a bound that is not there counts to be: a row with a multiplier at it is far from optimal."""


@dataclass(frozen=True)
class QuadraticProgram:
    """min 1/2 d^T H d + g^T d with lower <= A d <= upper.

    Attributes:
        hessian: H, (n, n), positive definite, sorted.
        gradient: g, (n,).
        rows: A, (m, n), sorted.
        lower, upper: (m,).
    """

    hessian: csc_array
    gradient: Array
    rows: csc_array
    lower: Array
    upper: Array


@dataclass(frozen=True)
class QpAnswer:
    """What a solver says; its status is not asked.

    Attributes:
        step: d, (n,).
        multipliers: of the rows, (m,), positive at upper bounds: H d + g + A^T multipliers = 0.
    """

    step: Array
    multipliers: Array


class QpSolver(Protocol):
    """Solves sparse quadratic programs."""

    def solve(self, program: QuadraticProgram, tolerance: float) -> QpAnswer:
        """Return the minimiser; ``tolerance`` is absolute, of feasibility and stationarity."""
        ...


def residual(program: QuadraticProgram, answer: QpAnswer) -> float:
    """Return the largest violation of the optimality conditions; infinite if the answer is not finite.

    Stationarity counts relative to the gradient, complementarity as the distance of a row with a multiplier from its
    bound, times the multiplier relative to the gradient.
    """
    step, multipliers = answer.step, answer.multipliers
    if not (np.isfinite(step).all() and np.isfinite(multipliers).all()):
        return float("inf")
    scale = max(1.0, float(np.abs(program.gradient).max(initial=0.0)))
    stationarity = program.hessian @ step + program.gradient + program.rows.T @ multipliers
    value = program.rows @ step
    violation = np.maximum(program.lower - value, value - program.upper)
    bound = np.where(multipliers > 0.0, program.upper, program.lower)
    slack = np.where(np.abs(multipliers) > 0.0, np.abs(value - np.where(np.isfinite(bound), bound, _OPEN_BOUND)), 0.0)
    return float(
        max(
            np.abs(stationarity).max(initial=0.0) / scale,
            violation.max(initial=0.0),
            (np.abs(multipliers) * slack).max(initial=0.0) / scale,
        )
    )
