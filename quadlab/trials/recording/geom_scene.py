"""The robot and its surroundings as scene entities, drawn once and moved by /tf."""

from collections.abc import Callable, Sequence

import numpy as np
from foxglove_schemas_protobuf.CubePrimitive_pb2 import CubePrimitive
from foxglove_schemas_protobuf.CylinderPrimitive_pb2 import CylinderPrimitive
from foxglove_schemas_protobuf.Point3_pb2 import Point3
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from foxglove_schemas_protobuf.SpherePrimitive_pb2 import SpherePrimitive
from foxglove_schemas_protobuf.TriangleListPrimitive_pb2 import TriangleListPrimitive
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3

from quadlab.errors import LogError
from quadlab.geometry.rotations import Array, quat_to_matrix
from quadlab.simulation.geom_description import GeomDescription
from quadlab.trials.recording.primitives import colour, entity, pose

_PLANE_THICKNESS = 0.002  # [m]
_ENDLESS_PLANE = 20.0  # [m], edge that is drawn of a plane without an edge


def geom_scene(geoms: Sequence[GeomDescription], time_ns: int) -> SceneUpdate:
    """Return one entity for each body of ``geoms``, locked to the frame that bears its name.

    Raises:
        LogError: if a shape is of no known kind, or a mesh has no vertices or faces.
    """
    entities: dict[str, SceneEntity] = {}
    for geom in geoms:
        if geom.kind not in _DRAW:
            raise LogError(f"geom of body '{geom.body}': kind '{geom.kind}'; known: {', '.join(_DRAW)}")
        if geom.body not in entities:
            entities[geom.body] = entity(f"geoms/{geom.body}", geom.body, time_ns, frame_locked=True)
        _DRAW[geom.kind](entities[geom.body], geom)
    return SceneUpdate(entities=list(entities.values()))


def _draw_box(target: SceneEntity, geom: GeomDescription) -> None:
    target.cubes.append(_cube(geom, geom.position, 2.0 * geom.size))


def _draw_plane(target: SceneEntity, geom: GeomDescription) -> None:
    edges = [2.0 * half if half > 0.0 else _ENDLESS_PLANE for half in geom.size[:2]]
    normal = quat_to_matrix(geom.quat_wxyz)[:, 2]
    centre = geom.position - 0.5 * _PLANE_THICKNESS * normal
    target.cubes.append(_cube(geom, centre, np.array([*edges, _PLANE_THICKNESS])))


def _draw_sphere(target: SceneEntity, geom: GeomDescription) -> None:
    target.spheres.append(_ball(geom, geom.position))


def _draw_cylinder(target: SceneEntity, geom: GeomDescription) -> None:
    radius, half_length = geom.size[:2]
    target.cylinders.append(
        CylinderPrimitive(
            pose=pose(geom.position, geom.quat_wxyz),
            size=Vector3(x=2.0 * radius, y=2.0 * radius, z=2.0 * half_length),
            bottom_scale=1.0,
            top_scale=1.0,
            color=colour(geom.rgba),
        )
    )


def _draw_capsule(target: SceneEntity, geom: GeomDescription) -> None:
    _draw_cylinder(target, geom)
    axis = quat_to_matrix(geom.quat_wxyz)[:, 2]
    target.spheres.extend(_ball(geom, geom.position + side * geom.size[1] * axis) for side in (-1.0, 1.0))


def _draw_mesh(target: SceneEntity, geom: GeomDescription) -> None:
    if geom.vertices is None or geom.faces is None:
        raise LogError(f"geom of body '{geom.body}': a mesh needs vertices (n, 3) and faces (m, 3)")
    target.triangles.append(
        TriangleListPrimitive(
            pose=pose(geom.position, geom.quat_wxyz),
            points=[Point3(x=x, y=y, z=z) for x, y, z in geom.vertices.tolist()],
            color=colour(geom.rgba),
            indices=geom.faces.ravel().tolist(),
        )
    )


def _cube(geom: GeomDescription, centre: Array, edges: Array) -> CubePrimitive:
    size = Vector3(x=edges[0], y=edges[1], z=edges[2])
    return CubePrimitive(pose=pose(centre, geom.quat_wxyz), size=size, color=colour(geom.rgba))


def _ball(geom: GeomDescription, centre: Array) -> SpherePrimitive:
    diameter = 2.0 * geom.size[0]
    size = Vector3(x=diameter, y=diameter, z=diameter)
    return SpherePrimitive(pose=pose(centre), size=size, color=colour(geom.rgba))


_DRAW: dict[str, Callable[[SceneEntity, GeomDescription], None]] = {
    "box": _draw_box,
    "plane": _draw_plane,
    "sphere": _draw_sphere,
    "cylinder": _draw_cylinder,
    "capsule": _draw_capsule,
    "mesh": _draw_mesh,
}
