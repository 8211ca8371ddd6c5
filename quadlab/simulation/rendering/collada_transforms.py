"""Transforms of COLLADA nodes."""

import math
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from quadlab.errors import RobotDescriptionError
from quadlab.geometry.rotations import Array, skew


def node_transform(node: ET.Element, path: Path) -> Array:
    """Return the product of the transforms of ``node`` in file order, (4, 4).

    Raises:
        RobotDescriptionError: on <skew> and <lookat>.
    """
    transform = np.eye(4)
    for child in node:
        if child.tag in ("skew", "lookat"):
            raise RobotDescriptionError(f"{path}: the transform <{child.tag}> is not supported")
        if child.tag in ("matrix", "translate", "rotate", "scale"):
            transform = transform @ _elementary(child.tag, np.array((child.text or "").split(), dtype=float))
    return transform


def _elementary(kind: str, values: Array) -> Array:
    if kind == "matrix":
        return values.reshape(4, 4)
    transform = np.eye(4)
    if kind == "translate":
        transform[:3, 3] = values
    elif kind == "scale":
        transform[:3, :3] = np.diag(values)
    else:
        transform[:3, :3] = _rotation(values[:3], math.radians(values[3]))
    return transform


def _rotation(axis: Array, angle: float) -> Array:
    """Return the rotation by ``angle`` in [rad] about ``axis``: I + sin(a) S + (1 - cos(a)) S S."""
    s = skew(axis / np.linalg.norm(axis))
    return np.eye(3) + math.sin(angle) * s + (1.0 - math.cos(angle)) * s @ s
