"""The URDF text from which every model of a robot is built: Pinocchio's and the simulator's alike."""

import difflib
import importlib.metadata
import re
import sys
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from quadlab.errors import RobotDescriptionError
from quadlab.robots.config import DescriptionOverrides, RobotConfig

_PACKAGE = "example-robot-data"
_NAMED_FILES = 5
_INERTIA_ENTRIES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def description_folder() -> Path:
    """Return the folder ``robots`` of the installed package example-robot-data.

    Raises:
        RobotDescriptionError: if the package or its data are not found.
    """
    suffix = Path("cmeel.prefix") / "share" / _PACKAGE / "robots"
    try:
        candidates = [Path(str(importlib.metadata.distribution(_PACKAGE).locate_file(suffix)))]
    except importlib.metadata.PackageNotFoundError:
        candidates = []
    candidates += [Path(entry) / suffix for entry in sys.path]
    for candidate in candidates:
        if candidate.is_dir():
            return candidate.resolve()
    raise RobotDescriptionError(f"robot descriptions not found; expected the package '{_PACKAGE}' to be installed")


def urdf_path(config: RobotConfig) -> Path:
    """Return the path of the robot's URDF.

    Raises:
        RobotDescriptionError: if there is no such file; the message names those whose names are nearest.
    """
    path = description_folder() / config.urdf
    if path.is_file():
        return path
    known = sorted(str(found.relative_to(description_folder())) for found in description_folder().glob("**/*.urdf"))
    nearest = difflib.get_close_matches(config.urdf, known, _NAMED_FILES, cutoff=0.0)
    raise RobotDescriptionError(
        f"robot {config.name}: no URDF '{config.urdf}'; of {len(known)} the nearest: {', '.join(nearest)}"
    )


def load_urdf_text(config: RobotConfig) -> str:
    """Return the robot's URDF with the overrides of its configuration applied.

    Raises:
        RobotDescriptionError: if the file is missing or not XML, or an override matches nothing.
    """
    path = urdf_path(config)
    try:
        robot = ET.parse(path).getroot()
    except ET.ParseError as error:
        raise RobotDescriptionError(f"robot {config.name}: {path.name} is not well-formed XML: {error}") from error
    for link in robot.findall("link"):
        _drop_products_of_rank_one_inertia(link)
    _override_masses(robot, config.overrides.mass_kg)
    _override_joints(robot, config.overrides)
    return ET.tostring(robot, encoding="unicode")


def _drop_products_of_rank_one_inertia(link: ET.Element) -> None:
    """Make the inertia of a placeholder link (all six entries equal, hence rank one) positive definite."""
    inertia = link.find("inertial/inertia")
    if inertia is None:
        return
    ixx, ixy, ixz, iyy, iyz, izz = (float(inertia.get(entry, "0")) for entry in _INERTIA_ENTRIES)
    matrix = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    if ixx > 0.0 and np.linalg.eigvalsh(matrix)[0] <= 1e-9 * ixx:
        for product in ("ixy", "ixz", "iyz"):
            inertia.set(product, "0")


def _override_masses(robot: ET.Element, masses: Mapping[str, float]) -> None:
    links = {link.get("name", ""): link for link in robot.findall("link")}
    for name, mass_kg in masses.items():
        mass = links[name].find("inertial/mass") if name in links else None
        inertia = links[name].find("inertial/inertia") if name in links else None
        if mass is None or inertia is None:
            known = (link for link, element in links.items() if element.find("inertial") is not None)
            raise RobotDescriptionError(f"overrides.mass_kg: no link with mass '{name}'; known: {', '.join(known)}")
        scale = mass_kg / float(mass.get("value", "0"))
        mass.set("value", repr(mass_kg))
        for entry in _INERTIA_ENTRIES:
            inertia.set(entry, repr(scale * float(inertia.get(entry, "0"))))


def _override_joints(robot: ET.Element, overrides: DescriptionOverrides) -> None:
    lower = {pattern: limits[0] for pattern, limits in overrides.position_rad.items()}
    upper = {pattern: limits[1] for pattern, limits in overrides.position_rad.items()}
    _override_attribute(robot, "limit", "effort", overrides.effort_nm)
    _override_attribute(robot, "limit", "velocity", overrides.velocity_radps)
    _override_attribute(robot, "limit", "lower", lower)
    _override_attribute(robot, "limit", "upper", upper)
    _override_attribute(robot, "dynamics", "damping", overrides.damping_nms)
    _override_attribute(robot, "dynamics", "friction", overrides.friction_nm)


def _override_attribute(robot: ET.Element, tag: str, attribute: str, values: Mapping[str, float]) -> None:
    """Set ``attribute`` of the child ``tag`` of every moving joint whose whole name matches a pattern."""
    joints = {joint.get("name", ""): joint for joint in robot.findall("joint") if joint.get("type") != "fixed"}
    for pattern, value in values.items():
        matching = [joint for name, joint in joints.items() if re.fullmatch(pattern, name)]
        if not matching:
            raise RobotDescriptionError(f"overrides: no joint matches '{pattern}'; known: {', '.join(joints)}")
        for joint in matching:
            element = joint.find(tag)
            if element is None:
                element = ET.SubElement(joint, tag)
            element.set(attribute, repr(float(value)))
