"""The <visual> elements of a URDF: what each link looks like."""

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quadlab.errors import RobotDescriptionError
from quadlab.geometry.rotations import Array, rotation_zyx

PRIMITIVES = ("box", "cylinder", "sphere")


@dataclass(frozen=True)
class LinkVisual:
    """One visible shape of a link.

    Attributes:
        link: name of the link.
        position: of the shape in the link frame, (3,) in [m].
        rotation: shape to link frame, (3, 3).
        shape: 'box', 'cylinder', 'sphere' or 'mesh'.
        size: box: edge lengths; cylinder: radius, length, 0; sphere: radius, 0, 0 in [m]; mesh: scale factors; (3,).
        mesh: file of a mesh; None for the others.
        rgba: colour of the material in 0 to 1, (4,); None if the URDF gives none.
    """

    link: str
    position: Array
    rotation: Array
    shape: str
    size: Array
    mesh: Path | None
    rgba: Array | None


def link_visuals(urdf_text: str, urdf_folder: Path, packages: dict[str, Path]) -> list[LinkVisual]:
    """Return every visible shape of a URDF.

    Args:
        urdf_text: the URDF.
        urdf_folder: relative mesh paths start here.
        packages: folder of each package named by a ``package://`` path.

    Raises:
        RobotDescriptionError: if a shape is unknown or a mesh path cannot be resolved.
    """
    robot = ET.fromstring(urdf_text)
    shared = {material.get("name", ""): _rgba(material) for material in robot.findall("material")}
    visuals = []
    for link in robot.findall("link"):
        for visual in link.findall("visual"):
            shape = visual.find("geometry/*")
            if shape is not None:
                rgba = _material_rgba(visual.find("material"), shared)
                visuals.append(_visual(link.get("name", ""), visual, shape, rgba, (urdf_folder, packages)))
    return visuals


def _visual(
    link: str, visual: ET.Element, shape: ET.Element, rgba: Array | None, folders: tuple[Path, dict[str, Path]]
) -> LinkVisual:
    origin = visual.find("origin")
    attributes = {} if origin is None else origin.attrib
    roll, pitch, yaw = _numbers(attributes.get("rpy", "0 0 0"))
    mesh = _mesh_path(shape.get("filename", ""), *folders) if shape.tag == "mesh" else None
    position, rotation = _numbers(attributes.get("xyz", "0 0 0")), rotation_zyx(yaw, pitch, roll)
    return LinkVisual(link, position, rotation, shape.tag, _size(link, shape), mesh, rgba)


def _size(link: str, shape: ET.Element) -> Array:
    if shape.tag == "box":
        return _numbers(shape.get("size", ""))
    if shape.tag == "cylinder":
        return np.array([float(shape.get("radius", "0")), float(shape.get("length", "0")), 0.0])
    if shape.tag == "sphere":
        return np.array([float(shape.get("radius", "0")), 0.0, 0.0])
    if shape.tag == "mesh":
        return _numbers(shape.get("scale", "1 1 1"))
    known = ", ".join((*PRIMITIVES, "mesh"))
    raise RobotDescriptionError(f"link {link}: unknown visual shape '{shape.tag}'; known: {known}")


def _mesh_path(filename: str, urdf_folder: Path, packages: dict[str, Path]) -> Path:
    if filename.startswith("package://"):
        package, _, inside = filename.removeprefix("package://").partition("/")
        if package not in packages:
            raise RobotDescriptionError(f"{filename}: unknown package '{package}'; known: {', '.join(packages)}")
        return packages[package] / inside
    return urdf_folder / filename.removeprefix("file://")


def _material_rgba(material: ET.Element | None, shared: dict[str, Array | None]) -> Array | None:
    if material is None:
        return None
    own = _rgba(material)
    return shared.get(material.get("name", "")) if own is None else own


def _rgba(material: ET.Element) -> Array | None:
    color = material.find("color")
    return None if color is None else _numbers(color.get("rgba", "1 1 1 1"))


def _numbers(text: str) -> Array:
    return np.array([float(word) for word in text.split()])
