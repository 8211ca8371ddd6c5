"""Gauss-Newton Hessians of fixed pattern: from small dense blocks straight to the sparse matrix by free variables."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, csr_array

from quadlab.geometry.rotations import Array
from quadlab.robots.pinocchio_model import IndexArray


@dataclass(frozen=True)
class HessianAssembly:
    """H = T^T (sum of blocks) T + H_0 with a pattern that never changes, zeros included.

    Attributes:
        scatter: takes the entries of all blocks to the stored entries of H.
        constant: stored entries of H_0.
        rows, starts: pattern in compressed columns, sorted.
        size: rows of H.
    """

    scatter: csr_array
    constant: Array
    rows: IndexArray
    starts: IndexArray
    size: int

    def assemble(self, blocks: Sequence[Array]) -> csc_array:
        """Return H for blocks (groups, v, v), in the order in which their variables were given."""
        data = self.scatter @ np.concatenate([block.ravel() for block in blocks]) + self.constant
        return csc_array((data, self.rows, self.starts), shape=(self.size, self.size))


def hessian_assembly(transform: csr_array, variables: Sequence[IndexArray], constant: csc_array) -> HessianAssembly:
    """Return the assembly.

    Args:
        transform: T, (size of p, size of y).
        variables: of every kind of block its variables in p, (groups, v) each.
        constant: H_0, (size of y, size of y).
    """
    size = transform.shape[1]
    first = np.concatenate([np.repeat(index, index.shape[1], axis=1).ravel() for index in variables])
    second = np.concatenate([np.tile(index, (1, index.shape[1])).ravel() for index in variables])
    entry, row, column, factor = _transformed(transform, first, second)
    fixed = constant.tocoo()
    keys = np.concatenate([column * size + row, fixed.col.astype(np.intp) * size + fixed.row])
    pattern, place = np.unique(keys, return_inverse=True)
    scatter = csr_array((factor, (place[: len(entry)], entry)), shape=(len(pattern), len(first)))
    values: Array = np.bincount(place[len(entry) :], weights=fixed.data, minlength=len(pattern)).astype(float)
    starts = np.searchsorted(pattern, np.arange(size + 1) * size)
    return HessianAssembly(scatter, values, (pattern % size).astype(np.int32), starts.astype(np.int32), size)


def _transformed(
    transform: csr_array, first: IndexArray, second: IndexArray
) -> tuple[IndexArray, IndexArray, IndexArray, Array]:
    """Return what T^T M T makes of each entry (first, second) of M: its number, row, column and factor."""
    counts = np.diff(transform.indptr)
    rights = counts[second]
    pairs = counts[first] * rights
    entry = np.repeat(np.arange(len(first)), pairs)
    rank = np.arange(len(entry)) - np.repeat(np.cumsum(pairs) - pairs, pairs)
    width = np.maximum(rights[entry], 1)
    left = transform.indptr[first[entry]] + rank // width
    right = transform.indptr[second[entry]] + rank % width
    row, column = transform.indices[left].astype(np.intp), transform.indices[right].astype(np.intp)
    return entry, row, column, transform.data[left] * transform.data[right]
