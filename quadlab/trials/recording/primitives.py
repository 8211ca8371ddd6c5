"""Foxglove drawing primitives from arrays."""

import math
from collections.abc import Iterable, Sequence

import numpy as np
from foxglove_schemas_protobuf.ArrowPrimitive_pb2 import ArrowPrimitive
from foxglove_schemas_protobuf.Color_pb2 import Color
from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive
from foxglove_schemas_protobuf.Point3_pb2 import Point3
from foxglove_schemas_protobuf.Pose_pb2 import Pose
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SpherePrimitive_pb2 import SpherePrimitive
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from google.protobuf.timestamp_pb2 import Timestamp

from quadlab.geometry.rotations import Array
from quadlab.trials.recording.log_file import NANOSECONDS

Rgba = tuple[float, float, float, float]

LEG_COLOURS: tuple[Rgba, ...] = (
    (0.00, 0.45, 0.70, 1.0),
    (0.84, 0.37, 0.00, 1.0),
    (0.00, 0.62, 0.45, 1.0),
    (0.80, 0.47, 0.65, 1.0),
)
"""One colour a leg, order ``LEGS``, distinguishable for colour-blind readers."""

FORCE_SCALE = 1.0 / 800.0
"""Length of a drawn force in [m/N]."""

_ARROW_DIAMETER, _ARROW_HEAD = 0.012, 0.03  # [m]
_IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


def stamp(time_ns: int) -> Timestamp:
    """Return ``time_ns`` in [ns] as a protobuf time stamp."""
    return Timestamp(seconds=time_ns // NANOSECONDS, nanos=time_ns % NANOSECONDS)


def vector(values: Array | Sequence[float]) -> Vector3:
    """Return (3,) ``values`` as a Foxglove vector."""
    return Vector3(x=values[0], y=values[1], z=values[2])


def quaternion(quat_wxyz: Array | Sequence[float]) -> Quaternion:
    """Return a (4,) wxyz quaternion as a Foxglove one."""
    return Quaternion(w=quat_wxyz[0], x=quat_wxyz[1], y=quat_wxyz[2], z=quat_wxyz[3])


def pose(position: Array, quat_wxyz: Array = _IDENTITY) -> Pose:
    """Return position (3,) in [m] and orientation (4,) as a Foxglove pose."""
    return Pose(position=vector(position), orientation=quaternion(quat_wxyz))


def colour(rgba: Rgba) -> Color:
    """Return a colour with components in [0, 1]."""
    return Color(r=rgba[0], g=rgba[1], b=rgba[2], a=rgba[3])


def entity(name: str, frame: str, time_ns: int, *, frame_locked: bool = False) -> SceneEntity:
    """Return an empty entity; a later one of the same name takes its place."""
    return SceneEntity(timestamp=stamp(time_ns), id=name, frame_id=frame, frame_locked=frame_locked)


def sphere(centre: Array, diameter: float, rgba: Rgba) -> SpherePrimitive:
    """Return a sphere at ``centre`` (3,), lengths in [m]."""
    size = Vector3(x=diameter, y=diameter, z=diameter)
    return SpherePrimitive(pose=pose(centre), size=size, color=colour(rgba))


def polyline(points: Iterable[Array], thickness: float, rgba: Rgba, *, closed: bool = False) -> LinePrimitive:
    """Return a line through points (3,), lengths in [m]."""
    return LinePrimitive(
        type=LinePrimitive.LINE_LOOP if closed else LinePrimitive.LINE_STRIP,
        pose=pose(np.zeros(3)),
        thickness=thickness,
        points=[Point3(x=p[0], y=p[1], z=p[2]) for p in points],
        color=colour(rgba),
    )


def force_arrow(point: Array, force: Array, rgba: Rgba) -> ArrowPrimitive:
    """Return an arrow that starts at ``point`` (3,) in [m] and shows ``force`` (3,) in [N], not zero."""
    length = float(np.linalg.norm(force))
    return ArrowPrimitive(
        pose=pose(point, quat_from_x_to(force / length)),
        shaft_length=length * FORCE_SCALE,
        shaft_diameter=_ARROW_DIAMETER,
        head_length=_ARROW_HEAD,
        head_diameter=2.0 * _ARROW_DIAMETER,
        color=colour(rgba),
    )


def quat_from_x_to(direction: Array) -> Array:
    """Return the shortest rotation, (4,) wxyz, that turns the x axis into the unit vector ``direction`` (3,)."""
    w = 1.0 + float(direction[0])
    if w < 1e-9:
        return np.array([0.0, 0.0, 0.0, 1.0])
    quat = np.array([w, 0.0, -direction[2], direction[1]])
    return quat / math.sqrt(float(quat @ quat))
