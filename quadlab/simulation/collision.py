"""Simple shapes of trunk and legs, so that a falling robot lands on the ground instead of sinking into it."""

import xml.etree.ElementTree as ET
from typing import Any

import mujoco
import numpy as np
import pinocchio as pin

from quadlab.geometry.rotations import Array, matrix_to_quat
from quadlab.robots.model import RobotModel
from quadlab.robots.pinocchio_model import foot_links_in_urdf

ROBOT_CONTACTS = 2
TERRAIN_CONTACTS = 1
"""Contact types: robot geoms collide with terrain geoms and with nothing else."""

COLLISION_GROUP = 3
"""Geom group of these shapes; hidden by default in viewers."""

_SMALLEST_SHAPE = 0.01  # [m], leaves out the millimetre cubes that mark cameras and sensors


def add_collision_shapes(spec: Any, robot: RobotModel) -> None:
    """Add the URDF's primitive collision shapes, and substitutes where it has only meshes."""
    feet = set(foot_links_in_urdf(robot.config))
    for link in ET.fromstring(robot.urdf_text).findall("link"):
        for element in link.findall("collision"):
            name = link.get("name", "")
            if not (name in feet and element.find("geometry/sphere") is not None):
                _add_primitive(spec.body(name), element)
    if robot.config.base_box_m is not None:
        half_size = 0.5 * np.array(robot.config.base_box_m)
        _add_shape(spec.body(robot.config.base_link), mujoco.mjtGeom.mjGEOM_BOX, half_size)


def _add_primitive(body: Any, element: ET.Element) -> None:
    shape = _shape(element)
    if shape is None or float(np.max(shape[1])) < _SMALLEST_SHAPE:
        return
    origin = element.find("origin")
    position, roll_pitch_yaw = np.zeros(3), np.zeros(3)
    if origin is not None:
        position = _numbers(origin.get("xyz", "0 0 0"))
        roll_pitch_yaw = _numbers(origin.get("rpy", "0 0 0"))
    quat = matrix_to_quat(pin.rpy.rpyToMatrix(roll_pitch_yaw))
    _add_shape(body, shape[0], shape[1], pos=position, quat=quat)


def _shape(element: ET.Element) -> tuple[Any, Array] | None:
    """Return MuJoCo's type and size, (3,), of a URDF primitive; None for a mesh."""
    box, cylinder, sphere = (element.find(f"geometry/{tag}") for tag in ("box", "cylinder", "sphere"))
    if box is not None:
        return mujoco.mjtGeom.mjGEOM_BOX, 0.5 * _numbers(box.get("size", ""))
    if cylinder is not None:
        radius, length = float(cylinder.get("radius", "0")), float(cylinder.get("length", "0"))
        return mujoco.mjtGeom.mjGEOM_CYLINDER, np.array([radius, 0.5 * length, 0.0])
    if sphere is not None:
        return mujoco.mjtGeom.mjGEOM_SPHERE, np.array([float(sphere.get("radius", "0")), 0.0, 0.0])
    return None


def _add_shape(body: Any, kind: Any, size: Array, **placement: Array) -> None:
    body.add_geom(
        type=kind,
        size=size,
        contype=ROBOT_CONTACTS,
        conaffinity=TERRAIN_CONTACTS,
        group=COLLISION_GROUP,
        mass=0.0,
        rgba=[0.8, 0.3, 0.3, 0.3],
        **placement,
    )


def _numbers(text: str) -> Array:
    return np.array([float(number) for number in text.split()])
