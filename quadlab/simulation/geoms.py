"""The shapes of a compiled model as plain descriptions."""

from typing import Any

import mujoco
import numpy as np

from quadlab.simulation.geom_description import GeomDescription, GeomKind

_KINDS: dict[int, GeomKind] = {
    int(mujoco.mjtGeom.mjGEOM_BOX): "box",
    int(mujoco.mjtGeom.mjGEOM_SPHERE): "sphere",
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): "cylinder",
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): "capsule",
    int(mujoco.mjtGeom.mjGEOM_MESH): "mesh",
    int(mujoco.mjtGeom.mjGEOM_PLANE): "plane",
}


def describe_geoms(model: Any) -> list[GeomDescription]:
    """Return the shapes of ``model`` (a ``mujoco.MjModel``), each in the frame of its body."""
    return [_describe(model, geom) for geom in range(model.ngeom) if int(model.geom_type[geom]) in _KINDS]


def _describe(model: Any, geom: int) -> GeomDescription:
    kind = _KINDS[int(model.geom_type[geom])]
    vertices, faces = _mesh(model, int(model.geom_dataid[geom])) if kind == "mesh" else (None, None)
    red, green, blue, alpha = (float(value) for value in model.geom_rgba[geom])
    return GeomDescription(
        body=model.body(int(model.geom_bodyid[geom])).name,
        kind=kind,
        position=model.geom_pos[geom].copy(),
        quat_wxyz=model.geom_quat[geom].copy(),
        size=model.geom_size[geom].copy(),
        rgba=(red, green, blue, alpha),
        vertices=vertices,
        faces=faces,
    )


def _mesh(model: Any, mesh: int) -> tuple[Any, Any]:
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    first_face, face_count = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    vertices = np.asarray(model.mesh_vert[first : first + count], dtype=np.float64)
    return vertices, model.mesh_face[first_face : first_face + face_count].copy()
