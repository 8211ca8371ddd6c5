"""Simple shapes of trunk and legs, so that a falling robot lands on the ground instead of sinking into it."""

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
import pinocchio as pin

from quadlab.geometry.rotations import Array, matrix_to_quat
from quadlab.robots.config import foot_links_in_urdf
from quadlab.robots.legs import JOINTS_PER_LEG
from quadlab.robots.model import RobotModel

ROBOT_CONTACTS = 2
TERRAIN_CONTACTS = 1
"""Contact types: robot geoms collide with terrain geoms and with nothing else."""

COLLISION_GROUP = 3
"""Geom group of these shapes; hidden by default in viewers."""

_SMALLEST_SHAPE = 0.01  # [m], leaves out the millimetre cubes that mark cameras and sensors
_LEG_THICKNESS = 0.8  # radius of substitute legs over that of the foot: the foot touches level ground first


def add_collision_shapes(spec: Any, robot: RobotModel, carriers: Mapping[str, str]) -> None:
    """Add the URDF's primitive collision shapes, and substitutes where it has only meshes.

    Args:
        spec: ``mujoco.MjSpec`` with the robot's links as bodies.
        robot: the robot.
        carriers: for every link, the link that it moves with, see ``link_placements``.
    """
    feet = set(foot_links_in_urdf(robot.config))
    covered = set()
    for link in ET.fromstring(robot.urdf_text).findall("link"):
        name = link.get("name", "")
        for element in link.findall("collision"):
            is_foot = name in feet and element.find("geometry/sphere") is not None
            if not is_foot and _add_primitive(spec.body(name), element):
                covered.add(carriers[name])
    if robot.config.base_box_m is not None:
        half_size = 0.5 * np.array(robot.config.base_box_m)
        _add_shape(spec.body(robot.config.base_link), mujoco.mjtGeom.mjGEOM_BOX, half_size)
    _add_missing_legs(spec, robot, covered)


def _add_missing_legs(spec: Any, robot: RobotModel, covered: set[str]) -> None:
    """Add a capsule along every thigh and shank that has no shape of its own."""
    model = robot.pin_model
    for leg, foot in enumerate(foot_links_in_urdf(robot.config)):
        thigh, knee = robot.joint_names[JOINTS_PER_LEG * leg + 1 : JOINTS_PER_LEG * (leg + 1)]
        knee_in_thigh = model.jointPlacements[model.getJointId(knee)].translation
        foot_in_shank = model.frames[model.getFrameId(f"{foot}_center")].placement.translation
        for joint, end in ((thigh, knee_in_thigh), (knee, foot_in_shank)):
            body = spec.joint(joint).parent
            if body.name not in covered:
                size = np.array([_LEG_THICKNESS * robot.foot_radius, 0.0, 0.0])
                ends = np.concatenate([np.zeros(3), end])
                _add_shape(body, mujoco.mjtGeom.mjGEOM_CAPSULE, size, fromto=ends)


def _add_primitive(body: Any, element: ET.Element) -> bool:
    """Add a collision element of the URDF to ``body``; return whether it is a primitive of relevant size."""
    shape = _shape(element)
    if shape is None or float(np.max(shape[1])) < _SMALLEST_SHAPE:
        return False
    origin = element.find("origin")
    position, roll_pitch_yaw = np.zeros(3), np.zeros(3)
    if origin is not None:
        position = _numbers(origin.get("xyz", "0 0 0"))
        roll_pitch_yaw = _numbers(origin.get("rpy", "0 0 0"))
    quat = matrix_to_quat(pin.rpy.rpyToMatrix(roll_pitch_yaw))
    _add_shape(body, shape[0], shape[1], pos=position, quat=quat)
    return True


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
