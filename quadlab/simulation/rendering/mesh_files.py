"""Meshes from files: COLLADA (.dae), STL (.stl) and Wavefront (.obj)."""

from pathlib import Path

import numpy as np

from quadlab.errors import RobotDescriptionError
from quadlab.geometry.rotations import Array
from quadlab.simulation.rendering.collada import read_collada
from quadlab.simulation.rendering.mesh import TriangleMesh, merge
from quadlab.simulation.rendering.texture import colored_meshes

STL_HEADER_BYTES = 84
STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_mesh(path: Path) -> list[TriangleMesh]:
    """Return the meshes of a file, one for each colour, in [m].

    Raises:
        RobotDescriptionError: if the file is missing, broken, empty or of an unknown kind.
    """
    readers = {".dae": _read_dae, ".stl": _read_stl, ".obj": _read_obj}
    kind = path.suffix.lower()
    if kind not in readers:
        raise RobotDescriptionError(f"{path}: unknown kind of mesh '{kind}'; known: {', '.join(readers)}")
    if not path.is_file():
        raise RobotDescriptionError(f"{path}: the mesh file does not exist")
    try:
        meshes = readers[kind](path)
    except (ValueError, IndexError) as error:
        raise RobotDescriptionError(f"{path}: the mesh is damaged ({error})") from error
    if not any(len(mesh.triangles) for mesh in meshes):
        raise RobotDescriptionError(f"{path}: the mesh has no triangles")
    return meshes


def _read_dae(path: Path) -> list[TriangleMesh]:
    return merge([mesh for part in read_collada(path) for mesh in colored_meshes(part)])


def _read_stl(path: Path) -> list[TriangleMesh]:
    content = path.read_bytes()
    count = int.from_bytes(content[80:STL_HEADER_BYTES], "little")
    if len(content) == STL_HEADER_BYTES + count * STL_TRIANGLE.itemsize:
        corners = np.frombuffer(content, STL_TRIANGLE, count, STL_HEADER_BYTES)["corners"].astype(float)
    else:
        lines = (line.split() for line in content.decode("ascii").splitlines())
        corners = np.array([words[1:4] for words in lines if words[:1] == ["vertex"]], dtype=float).reshape(-1, 3, 3)
    return [_from_corners(corners)]


def _read_obj(path: Path) -> list[TriangleMesh]:
    """Read positions and faces; polygons are cut as fans, negative indices count from the end."""
    points: list[list[float]] = []
    triangles: list[tuple[int, int, int]] = []
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) for word in words[1:]]
            rows = [corner - 1 if corner > 0 else len(points) + corner for corner in corners]
            triangles += [(rows[0], rows[k], rows[k + 1]) for k in range(1, len(rows) - 1)]
    return [TriangleMesh(np.array(points).reshape(-1, 3), np.array(triangles, dtype=np.int32).reshape(-1, 3), None)]


def _from_corners(corners: Array) -> TriangleMesh:
    return TriangleMesh(corners.reshape(-1, 3), np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3), None)
