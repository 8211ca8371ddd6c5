"""Reader of COLLADA 1.4 and 1.5 (.dae) surfaces: the part of the format that robot descriptions use.

Read: <triangles>, <polylist>, <polygons> without holes, node transforms, instanced nodes, unit, diffuse colour or
texture. Lines and points are skipped: they have no surface. Everything else that would change the shape (skins, strips,
fans, splines) is an error, so that no part of a robot is lost in silence.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quadlab.errors import RobotDescriptionError
from quadlab.geometry.rotations import Array
from quadlab.simulation.rendering.collada_materials import Diffuse, diffuse_of
from quadlab.simulation.rendering.collada_polygons import Corners, corner_table
from quadlab.simulation.rendering.collada_transforms import node_transform

SURFACES = ("triangles", "polylist", "polygons")
WITHOUT_SURFACE = ("source", "vertices", "lines", "linestrips", "extra")


@dataclass(frozen=True)
class ColladaPart:
    """Triangles of one material.

    Attributes:
        corners: corner points of each triangle, (m, 3, 3) in [m].
        texture_coordinates: (m, 3, 2), origin at the lower left; None without.
        diffuse: colour or texture of the material.
    """

    corners: Array
    texture_coordinates: Array | None
    diffuse: Diffuse


def read_collada(path: Path) -> list[ColladaPart]:
    """Return the surfaces of a .dae file, placed by its scene, in [m].

    The up axis is not turned to z: viewers of robot descriptions do not turn it, and descriptions are made to look
    right in them.

    Raises:
        RobotDescriptionError: if the file is not COLLADA or uses what this reader does not know.
    """
    try:
        root = ET.parse(path).getroot()
    except (ET.ParseError, OSError) as error:
        raise RobotDescriptionError(f"{path}: cannot read the mesh ({error})") from error
    if not root.tag.endswith("}COLLADA") and root.tag != "COLLADA":
        raise RobotDescriptionError(f"{path}: expected the root element COLLADA, found '{root.tag}'")
    for element in root.iter():
        element.tag = element.tag.rpartition("}")[2]
    return _Document(path, root).parts()


class _Document:
    """One file: its elements by id, and the walk through its scene."""

    def __init__(self, path: Path, root: ET.Element) -> None:
        self._path = path
        self._root = root
        self._by_id = {element.get("id", ""): element for element in root.iter() if element.get("id")}

    def parts(self) -> list[ColladaPart]:
        unit = self._root.find("asset/unit")
        scale = 1.0 if unit is None else float(unit.get("meter", "1"))
        transform = np.eye(4)
        transform[:3, :3] = scale * np.eye(3)
        scene = self._root.find("scene/instance_visual_scene")
        if scene is None:
            raise RobotDescriptionError(f"{self._path}: the file has no scene")
        return list(self._walk(self._target(scene), transform))

    def _walk(self, node: ET.Element, outer: Array) -> Iterator[ColladaPart]:
        transform = outer @ node_transform(node, self._path)
        for child in node:
            if child.tag == "node":
                yield from self._walk(child, transform)
            elif child.tag == "instance_node":
                yield from self._walk(self._target(child), transform)
            elif child.tag == "instance_geometry":
                yield from self._geometry(child, transform)
            elif child.tag == "instance_controller":
                raise RobotDescriptionError(f"{self._path}: skinned meshes (instance_controller) are not supported")

    def _geometry(self, instance: ET.Element, transform: Array) -> Iterator[ColladaPart]:
        geometry = self._target(instance)
        mesh = geometry.find("mesh")
        if mesh is None:
            raise RobotDescriptionError(f"{self._path}: geometry '{geometry.get('id')}' holds no <mesh>")
        bound = {bind.get("symbol"): bind.get("target", "")[1:] for bind in instance.iter("instance_material")}
        for primitive in mesh:
            if primitive.tag in SURFACES:
                symbol = primitive.get("material")
                material = self._by_id.get(bound.get(symbol, symbol or ""))
                corners = corner_table(primitive, self._by_id, self._path)
                if len(corners.points):
                    yield _placed(corners, transform, diffuse_of(material, self._by_id, self._path))
            elif primitive.tag not in WITHOUT_SURFACE:
                known = ", ".join(SURFACES)
                raise RobotDescriptionError(f"{self._path}: <{primitive.tag}> is not supported; known: {known}")

    def _target(self, instance: ET.Element) -> ET.Element:
        url = instance.get("url", "")
        if url[1:] not in self._by_id:
            raise RobotDescriptionError(f"{self._path}: <{instance.tag}> points to '{url}', which is not in the file")
        return self._by_id[url[1:]]


def _placed(corners: Corners, transform: Array, diffuse: Diffuse) -> ColladaPart:
    """Return the triangles moved by ``transform``; a mirroring transform turns their winding round."""
    points = corners.points @ transform[:3, :3].T + transform[:3, 3]
    texture = corners.texture_coordinates
    if np.linalg.det(transform[:3, :3]) < 0.0:
        points = points[:, ::-1]
        texture = None if texture is None else texture[:, ::-1]
    return ColladaPart(points, texture, diffuse)
