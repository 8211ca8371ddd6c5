"""Eq. (5): small changes of velocity from sample to sample, of base, joints, CoM and feet."""

import numpy as np
from scipy.sparse import csr_array, vstack

from quadlab.geometry.rotations import Array, rotation_2d
from quadlab.planners.kinematic_sqp.grid import CycleSpan, SampleGrid
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import LinearTerm, rows
from quadlab.robots.pinocchio_model import IndexArray

_PLANAR = {"base_position": 1, "com": 1, "feet": 4}  # leading pairs x, y of a block that turn with the heading


def smoothness(name: str, blocks: tuple[str, ...], layout: SampleLayout, grid: SampleGrid, weight: float) -> LinearTerm:
    """Return the sum of squared changes of velocity of some blocks.

    Eq. (5) is printed with velocities per second. Here times count in units of the local sample period, h = (h_- +
    h_+) / 2: h [(q_i - q_{i-1}) / h_- - (q_{i+1} - q_i) / h_+], which is q_{i-1} - 2 q_i + q_{i+1} on equal steps.
    This is an inference: with velocities per second and the weights of Table I a trot of 0.8 s would pay 39 times more
    for the same path than a walk of 5 s, which outweighs the travelled distance, while the joint costs in
    Table I are smaller for the trot than for the walk. At a start or an end at rest the robot stands still before or
    after; where a cycle repeats, its own second sample follows, turned by the command.

    Args:
        name: of the objective.
        blocks: of p.
        layout: of p.
        grid: samples and repeated cycles.
        weight: in [1/m^2] or [1/rad^2].
    """
    parts = [part for block in blocks for part in _changes(layout, grid, block)]
    matrix = csr_array(vstack(parts, format="csr"))
    return LinearTerm(name, weight, matrix, np.zeros(matrix.shape[0]))


def _changes(layout: SampleLayout, grid: SampleGrid, block: str) -> list[csr_array]:
    index, size = layout.indices(block), layout.size
    width = index.shape[1]
    before, after = (np.repeat(periods, width) for periods in (grid.periods_s[:-1], grid.periods_s[1:]))
    mean = 0.5 * (before + after)
    earlier, inner, later = index[:-2].ravel(), index[1:-1].ravel(), index[2:].ravel()
    change = [(earlier, mean / before), (inner, -mean / before - mean / after), (later, mean / after)]
    parts = [rows(change, size), rows([(index[1], 1.0), (index[0], -1.0)], size)]
    if grid.ends_at_rest:
        parts.append(rows([(index[-1], 1.0), (index[-2], -1.0)], size))
    return [*parts, *(_wrapped(index, size, grid, span, _PLANAR.get(block, 0)) for span in grid.wraps)]


def _wrapped(index: IndexArray, size: int, grid: SampleGrid, span: CycleSpan, pairs: int) -> csr_array:
    """Return rows of the change of velocity at the end of a repeated cycle: of p_N - p_{N-1} and R (p_{p+1} - p_p)."""
    before, after = float(grid.periods_s[span.last - 1]), float(grid.periods_s[span.first])
    mean = 0.5 * (before + after)
    turn = _turn(index.shape[1], pairs, float(span.cycle.increment[2]))
    entries: list[tuple[IndexArray, Array | float]] = [
        (index[span.last], -mean / before),
        (index[span.last - 1], mean / before),
    ]
    for column in range(index.shape[1]):
        there = np.full(index.shape[1], index[span.first + 1, column])
        here = np.full(index.shape[1], index[span.first, column])
        entries += [(there, turn[:, column] * mean / after), (here, -turn[:, column] * mean / after)]
    matrix = rows(entries, size)
    matrix.eliminate_zeros()
    return matrix


def _turn(width: int, pairs: int, angle: float) -> Array:
    """Return the matrix that turns the leading pairs of a block and keeps the rest, (width, width)."""
    matrix = np.eye(width)
    for pair in range(pairs):
        matrix[2 * pair : 2 * pair + 2, 2 * pair : 2 * pair + 2] = rotation_2d(angle)
    return matrix
