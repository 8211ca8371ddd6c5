"""The quadratic program of a model, and the same with every bound made elastic to find out what contradicts."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import block_diag, csc_array, csr_array, diags_array, hstack, vstack

from quadlab.geometry.rotations import Array
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.zmp_spline.hermite import HermiteGrid, IntArray
from quadlab.planners.zmp_spline.terms import Bound, SquaredCost

_ELASTIC_PRICE = 1e6  # of squared violations in [1/m^2], against accelerations of order 1 m^2/s^3


@dataclass(frozen=True)
class QuadraticProgram:
    """min 1/2 z^T H z + g^T z with G z <= h over the free knot states, then the slacks of soft bounds.

    Attributes:
        hessian, gradient: H (n, n) and g (n,).
        rows, upper: G (m, n) and h (m,).
        costs, bounds: what it was assembled from, over all knot states.
        given: all knot states with zeros where they are free.
        free: columns of the free knot states.
    """

    hessian: csc_array
    gradient: Array
    rows: csc_array
    upper: Array
    costs: tuple[SquaredCost, ...]
    bounds: tuple[Bound, ...]
    given: Array
    free: IntArray

    def states(self, solution: Array) -> Array:
        """Return all knot states of a solution of the program."""
        states = self.given.copy()
        states[self.free] = solution[: len(self.free)]
        return states

    def cost_values(self, states: Array) -> dict[str, float]:
        """Return every cost by its name."""
        return {cost.name: cost.value(states) for cost in self.costs}

    def violations(self, states: Array) -> dict[str, float]:
        """Return the worst violation of every set of bounds by its name, in its own unit."""
        return {b.name: max(0.0, float((b.rows @ states - b.upper).max(initial=0.0))) for b in self.bounds}

    def worst_time_s(self, name: str, states: Array) -> float:
        """Return when a set of bounds is violated most, in [s]."""
        bound = next(bound for bound in self.bounds if bound.name == name)
        return float(bound.times_s[int(np.argmax(bound.rows @ states - bound.upper))])


def assemble(
    grid: HermiteGrid, problem: PlanningProblem, costs: Sequence[SquaredCost], bounds: Sequence[Bound]
) -> QuadraticProgram:
    """Return the program of named costs and bounds; start and end of the CoM are put in and no variables."""
    given, free = boundary_states(grid, problem)
    select = csc_array((np.ones(len(free)), (free, np.arange(len(free)))), shape=(grid.size, len(free)))
    hessian, gradient = csc_array((grid.size, grid.size)), np.zeros(grid.size)
    for cost in costs:
        weighted = diags_array(2.0 * cost.weights) @ cost.rows
        hessian = hessian + csc_array(cost.rows.T @ weighted)
        gradient += weighted.T @ (cost.rows @ given - cost.targets)
    rows = vstack([bound.rows for bound in bounds], format="csc")
    upper = np.concatenate([bound.upper for bound in bounds])
    slacks, prices = _slacks(bounds)
    return QuadraticProgram(
        hessian=csc_array(block_diag([select.T @ hessian @ select, diags_array(2.0 * prices)])),
        gradient=np.concatenate([select.T @ gradient, np.zeros(len(prices))]),
        rows=csc_array(hstack([rows @ select, -slacks])),
        upper=upper - rows @ given,
        costs=tuple(costs),
        bounds=tuple(bounds),
        given=given,
        free=free,
    )


def elastic(grid: HermiteGrid, problem: PlanningProblem, program: QuadraticProgram) -> QuadraticProgram:
    """Return the program whose bounds may all be violated, at a price."""
    bounds = [replace(bound, slack_weights=np.full(len(bound.upper), _ELASTIC_PRICE)) for bound in program.bounds]
    return assemble(grid, problem, program.costs, bounds)


def boundary_states(grid: HermiteGrid, problem: PlanningProblem) -> tuple[Array, IntArray]:
    """Return all knot states with the given ones filled in, (size,), and the columns of the free ones.

    Given are position and velocity at the start, and rest at the goal, acceleration included.
    """
    given, known = np.zeros(grid.size), []
    for axis in range(2):
        start = (problem.start.com_position[axis], problem.start.com_velocity[axis])
        goal = (problem.waypoints.poses[-1, axis], 0.0, 0.0)
        for knot, values in ((0, start), (grid.count, goal)):
            columns = [grid.column(knot, order, axis) for order in range(len(values))]
            given[columns] = values
            known += columns
    return given, np.setdiff1d(np.arange(grid.size), known)


def _slacks(bounds: Sequence[Bound]) -> tuple[csr_array, Array]:
    """Return which slack belongs to which row, (rows, slacks), and the price of each slack, (slacks,)."""
    prices = np.concatenate(
        [np.zeros(len(b.upper)) if b.slack_weights is None else b.slack_weights for b in bounds], dtype=float
    )
    soft = np.flatnonzero(prices)
    shape = (len(prices), len(soft))
    return csr_array((np.ones(len(soft)), (soft, np.arange(len(soft)))), shape=shape), prices[soft]
