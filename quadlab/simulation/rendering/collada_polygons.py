"""COLLADA primitives as triangles."""

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from quadlab.errors import RobotDescriptionError
from quadlab.geometry.rotations import Array

Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Corners:
    """Triangles, corner by corner, in the axes and units of the file.

    Attributes:
        points: (m, 3, 3).
        texture_coordinates: (m, 3, 2); None without.
    """

    points: Array
    texture_coordinates: Array | None


def corner_table(primitive: ET.Element, by_id: dict[str, ET.Element], path: Path) -> Corners:
    """Return the triangles of a <triangles>, <polylist> or <polygons> element; polygons are cut as fans.

    Raises:
        RobotDescriptionError: if the polygons have holes or point to data that does not exist.
    """
    inputs = {element.get("semantic", ""): element for element in reversed(primitive.findall("input"))}
    if "VERTEX" not in inputs:
        raise RobotDescriptionError(f"{path}: <{primitive.tag}> has no VERTEX input")
    stride = 1 + max(int(element.get("offset", "0")) for element in primitive.findall("input"))
    indices, sizes = _polygons(primitive, stride, path)
    corner_rows = indices[_fan(sizes)]

    def values(semantic: str, columns: int) -> Array:
        source = _source(inputs[semantic], by_id, path)
        return source[corner_rows[..., int(inputs[semantic].get("offset", "0"))], :columns]

    texture = values("TEXCOORD", 2) if "TEXCOORD" in inputs else None
    return Corners(values("VERTEX", 3), texture)


def _polygons(primitive: ET.Element, stride: int, path: Path) -> tuple[Indices, Indices]:
    """Return the index rows, (corners, stride), and the number of corners of each polygon, (polygons,)."""
    if primitive.find("ph") is not None:
        raise RobotDescriptionError(f"{path}: polygons with holes (<ph>) are not supported")
    lists = [np.array((p.text or "").split(), dtype=np.int64).reshape(-1, stride) for p in primitive.findall("p")]
    indices = np.concatenate([np.zeros((0, stride), np.int64), *lists])
    if primitive.tag == "polygons":
        return indices, np.array([len(rows) for rows in lists], dtype=np.int64)
    if primitive.tag == "polylist":
        return indices, np.array((primitive.findtext("vcount") or "").split(), dtype=np.int64)
    return indices, np.full(len(indices) // 3, 3, dtype=np.int64)


def _fan(sizes: Indices) -> Indices:
    """Return the corner rows of the triangles that fill polygons of ``sizes`` corners, (m, 3)."""
    first = np.cumsum(sizes) - sizes
    fans = [np.zeros((0, 3), np.int64)]
    for size in np.unique(sizes):
        start = first[sizes == size]
        fans += [np.stack([start, start + k, start + k + 1], axis=1) for k in range(1, size - 1)]
    return np.concatenate(fans)


def _source(element: ET.Element, by_id: dict[str, ET.Element], path: Path) -> Array:
    """Return the table of numbers, (rows, stride), that an <input> points to."""
    url = element.get("source", "")
    target = by_id.get(url[1:])
    if target is not None and target.tag == "vertices":
        for inner in target.findall("input"):
            if inner.get("semantic") == "POSITION":
                return _source(inner, by_id, path)
    accessor = None if target is None else target.find("technique_common/accessor")
    if target is None or accessor is None:
        raise RobotDescriptionError(f"{path}: the input '{url}' is not in the file or has no numbers")
    numbers = np.array((target.findtext("float_array") or "").split(), dtype=float)
    return numbers.reshape(-1, int(accessor.get("stride", "1")))
