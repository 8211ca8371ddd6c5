"""What the robot looks like, added to a MuJoCo specification as geoms that touch nothing and weigh nothing."""

from typing import Any

import mujoco
import numpy as np

from quadlab.geometry.rotations import Array, matrix_to_quat, quat_to_matrix
from quadlab.robots.description import description_folder, urdf_path
from quadlab.robots.model import RobotModel
from quadlab.simulation.links import LinkPlacement, link_placements
from quadlab.simulation.rendering.mesh_cache import load_compact
from quadlab.simulation.rendering.urdf_visuals import LinkVisual, link_visuals

VISUAL_GROUP = 2
HIDDEN_GROUP = 3
DEFAULT_RGBA = np.array([0.7, 0.7, 0.72, 1.0])
ROBOT_MATERIAL = "robot_surface"
FEWEST_VERTICES = 4
"""MuJoCo takes no mesh with fewer; a single triangle gets an unused one."""

SMALLEST_SIZE_M = 2e-3
"""Boxes of a millimetre are placeholders of links without a shape."""


def add_visuals(spec: Any, robot: RobotModel, cell_m: float) -> None:
    """Add the visual shapes of the robot's URDF to ``spec``, an ``MjSpec`` that is not compiled yet.

    A mesh keeps the colours of its file; the URDF's material colours what the file leaves open, and primitives.

    Args:
        spec: the specification; its bodies get geoms of group 2 without collision and mass.
        robot: gives the URDF and the poses of its links.
        cell_m: mesh vertices are merged in cells of this edge in [m]; 0 keeps all.

    Raises:
        RobotDescriptionError: if a mesh is missing, damaged or of an unknown kind.
    """
    spec.add_material(name=ROBOT_MATERIAL, specular=0.25, shininess=0.35)
    placements = link_placements(robot)
    visuals = _visuals_of(robot)
    for visual in visuals:
        placement = placements[visual.link]
        pose = _pose_in_body(visual, placement)
        body = spec.body(placement.body)
        if visual.shape == "mesh":
            _add_meshes(spec, body, visual, pose, cell_m)
        elif visual.size.max() > SMALLEST_SIZE_M:
            _add_primitive(body, visual, pose)
    _show_only_visuals(spec, bool(visuals))


def _visuals_of(robot: RobotModel) -> list[LinkVisual]:
    folder = description_folder()
    packages = {folder.parent.name: folder.parent}
    return link_visuals(robot.urdf_text, urdf_path(robot.config).parent, packages)


def _show_only_visuals(spec: Any, robot_has_visuals: bool) -> None:
    """Hide the collision shapes of the robot; a robot without visual shapes is drawn by them instead."""
    for geom in spec.geoms:
        if geom.parent.name != spec.worldbody.name and geom.group != VISUAL_GROUP:
            geom.group = HIDDEN_GROUP if robot_has_visuals else VISUAL_GROUP
            geom.rgba = [*DEFAULT_RGBA[:3], 1.0]


def _pose_in_body(visual: LinkVisual, placement: LinkPlacement) -> dict[str, Array]:
    link_to_body = quat_to_matrix(placement.quat_wxyz)
    return {
        "pos": placement.position + link_to_body @ visual.position,
        "quat": matrix_to_quat(link_to_body @ visual.rotation),
    }


def _add_meshes(spec: Any, body: Any, visual: LinkVisual, pose: dict[str, Array], cell_m: float) -> None:
    if visual.mesh is None:
        return
    for number, mesh in enumerate(load_compact(visual.mesh, cell_m)):
        scale = "x".join(f"{factor:g}" for factor in visual.size)
        name = f"visual_{visual.mesh.parent.name}_{visual.mesh.stem}_{scale}_{number}"
        if spec.mesh(name) is None:
            asset = spec.add_mesh(name=name, inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL)
            mirrored = float(np.prod(visual.size)) < 0.0
            missing = max(0, FEWEST_VERTICES - len(mesh.vertices))
            vertices = np.concatenate([mesh.vertices, mesh.vertices[:1].repeat(missing, axis=0)])
            asset.uservert = (vertices * visual.size).ravel().tolist()
            asset.userface = (mesh.triangles[:, ::-1] if mirrored else mesh.triangles).ravel().tolist()
        rgba = visual.rgba if mesh.rgba is None else mesh.rgba
        _add_geom(body, mujoco.mjtGeom.mjGEOM_MESH, pose, rgba, meshname=name)


def _add_primitive(body: Any, visual: LinkVisual, pose: dict[str, Array]) -> None:
    kinds = {
        "box": (mujoco.mjtGeom.mjGEOM_BOX, 0.5 * visual.size),
        "cylinder": (mujoco.mjtGeom.mjGEOM_CYLINDER, visual.size * [1.0, 0.5, 0.0]),
        "sphere": (mujoco.mjtGeom.mjGEOM_SPHERE, visual.size),
    }
    kind, size = kinds[visual.shape]
    _add_geom(body, kind, pose, visual.rgba, size=size)


def _add_geom(body: Any, kind: Any, pose: dict[str, Array], rgba: Array | None, **shape: Any) -> None:
    color = DEFAULT_RGBA if rgba is None else rgba
    untouchable = {"contype": 0, "conaffinity": 0, "mass": 0.0, "group": VISUAL_GROUP}
    body.add_geom(type=kind, rgba=color, material=ROBOT_MATERIAL, **untouchable, **pose, **shape)
