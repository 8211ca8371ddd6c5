"""Triangle meshes of one colour, and how to make them small."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quadlab.geometry.rotations import Array

IntArray = NDArray[np.int32]


@dataclass(frozen=True)
class TriangleMesh:
    """A surface of triangles in one colour.

    Attributes:
        vertices: (n, 3) in [m].
        triangles: rows of ``vertices`` seen counter-clockwise from outside, (m, 3).
        rgba: colour in 0 to 1, (4,); None if the file gives none.
    """

    vertices: Array
    triangles: IntArray
    rgba: Array | None

    @property
    def bounds(self) -> Array:
        """Lowest and highest coordinates, (2, 3) in [m]."""
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])


def compact(meshes: list[TriangleMesh], cell_m: float) -> list[TriangleMesh]:
    """Return the meshes with all vertices of one grid cell merged at their mean, over all colours, so without cracks.

    Triangles that lose a corner and repeated triangles go, and so do meshes that lose all triangles; the shape moves
    by less than a cell.

    Args:
        meshes: the colours of one object; files often repeat vertices at every triangle.
        cell_m: edge of the cubic cells in [m]; 0 merges only vertices that coincide (to a micrometre).
    """
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    cells = np.round(vertices / (cell_m or 1e-6)).astype(np.int64)
    _, cell_of_vertex, counts = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    cell_of_vertex = cell_of_vertex.ravel()
    sums = np.stack([np.bincount(cell_of_vertex, vertices[:, axis]) for axis in range(3)], axis=1)
    means = sums / counts[:, None]
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    small = []
    for mesh, offset in zip(meshes, offsets[:-1], strict=True):
        triangles = _without_degenerate(cell_of_vertex[mesh.triangles + offset])
        used, renumbered = np.unique(triangles, return_inverse=True)
        small.append(TriangleMesh(means[used], renumbered.reshape(-1, 3).astype(np.int32), mesh.rgba))
    return [mesh for mesh in small if len(mesh.triangles)]


def merge(meshes: list[TriangleMesh]) -> list[TriangleMesh]:
    """Return one mesh for each colour, in order of first appearance."""
    groups: dict[tuple[float, ...] | None, list[TriangleMesh]] = {}
    for mesh in meshes:
        key = None if mesh.rgba is None else tuple(float(value) for value in mesh.rgba)
        groups.setdefault(key, []).append(mesh)
    return [_joined(group) for group in groups.values()]


def _joined(meshes: list[TriangleMesh]) -> TriangleMesh:
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    triangles = [mesh.triangles + offset for mesh, offset in zip(meshes, offsets, strict=True)]
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    return TriangleMesh(vertices, np.concatenate(triangles).astype(np.int32), meshes[0].rgba)


def _without_degenerate(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    a, b, c = triangles.T
    proper = triangles[(a != b) & (b != c) & (c != a)]
    _, first = np.unique(np.sort(proper, axis=1), axis=0, return_index=True)
    return np.asarray(proper[np.sort(first)])
