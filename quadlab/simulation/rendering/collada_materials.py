"""Colour or texture of a COLLADA material."""

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote

import numpy as np

from quadlab.geometry.rotations import Array


@dataclass(frozen=True)
class Diffuse:
    """How a surface scatters light.

    Attributes:
        rgba: colour in 0 to 1, (4,); None if the material has none.
        texture: image file; None if the material has none.
    """

    rgba: Array | None
    texture: Path | None


def diffuse_of(material: ET.Element | None, by_id: dict[str, ET.Element], path: Path) -> Diffuse:
    """Return the diffuse colour or texture of ``material``; both None if it has none.

    Surfaces are drawn opaque: writers of the format disagree on what its transparency means.
    """
    instance = None if material is None else material.find("instance_effect")
    effect = None if instance is None else by_id.get(instance.get("url", "")[1:])
    diffuse = None if effect is None else effect.find(".//diffuse")
    if effect is None or diffuse is None:
        return Diffuse(None, None)
    color = diffuse.findtext("color")
    if color is not None:
        return Diffuse(np.array([*(float(value) for value in color.split()[:3]), 1.0]), None)
    texture = diffuse.find("texture")
    file = None if texture is None else _image_file(texture.get("texture", ""), effect, by_id)
    return Diffuse(None, None if file is None else path.parent / unquote(file.removeprefix("file://")))


def _image_file(name: str, effect: ET.Element, by_id: dict[str, ET.Element]) -> str | None:
    """Follow sampler -> surface -> image to the file name."""
    parameters = {element.get("sid"): element for element in effect.iter("newparam")}
    for _ in range(2):
        if name in parameters:
            name = (
                parameters[name].findtext("sampler2D/source") or parameters[name].findtext("surface/init_from") or name
            )
    image = by_id.get(name.strip())
    return None if image is None else (image.findtext("init_from") or image.findtext("init_from/ref"))
