"""Light, floor, sky and colours of the pictures.

A directional light with a shadow map leaves dark speckles on curved meshes, so that a high spot light throws the
shadows and a second light without shadows fills them. The floor throws no shadow, and fog hides where it ends.
"""

from typing import Any

import mujoco
import numpy as np

from quadlab.geometry.rotations import Array

KEY_LIGHT_OFFSET_SIZES = np.array([-1.4, -3.0, 4.6])
FILL_LIGHT_DIRECTION = (-0.8, 0.4, -0.8)
FOG_START_SIZES, FOG_END_SIZES = 4.0, 13.0
HORIZON_RGBA = (0.93, 0.95, 0.97, 1.0)
ZENITH_RGB = (0.78, 0.86, 0.94)
TILE_RGB = ((0.80, 0.805, 0.81), (0.745, 0.755, 0.765), (0.65, 0.66, 0.68))
WOOD_RGB = ((0.66, 0.50, 0.33), (0.62, 0.465, 0.30), (0.50, 0.37, 0.23))
"""Two colours of a checker board and the colour of the lines between."""

TILES_PER_METRE, BOARDS_PER_METRE = (2.0, 2.0), (1.0, 5.0)
ON_FLOOR_M = 1e-6
"""Pieces whose top is not above this height are the ground that the robot starts on."""

FLOOR_MATERIAL, WOOD_MATERIAL = "floor_surface", "wood_surface"
NOT_A_COLOR = (1.0, 1.0, 1.0, 1.0)


def apply_look(spec: Any, robot_size: float, shadow_pixels: int, samples: int, frame_shape: tuple[int, int]) -> None:
    """Give ``spec``, an ``MjSpec`` that is not compiled yet, its light, floor, sky and fog.

    Planes of the world body and the level ground at height zero are drawn as tiles, all else as wood.

    Args:
        spec: the specification.
        robot_size: in [m]; lights and fog scale with it.
        shadow_pixels: edge of the shadow map.
        samples: per pixel.
        frame_shape: height and width of the frames in pixels.
    """
    _add_surfaces(spec)
    _set_lights(spec, robot_size)
    for geom in spec.worldbody.geoms:
        geom.material = FLOOR_MATERIAL if _is_ground(geom) else WOOD_MATERIAL
        geom.rgba = NOT_A_COLOR
        geom.castshadow = geom.type != mujoco.mjtGeom.mjGEOM_PLANE
    visual = spec.visual
    spec.stat.extent = robot_size
    visual.map.znear, visual.map.zfar = 0.3, 30.0
    visual.map.fogstart, visual.map.fogend = FOG_START_SIZES, FOG_END_SIZES
    visual.map.shadowscale = 0.28
    visual.rgba.fog = visual.rgba.haze = HORIZON_RGBA
    visual.quality.shadowsize, visual.quality.offsamples = shadow_pixels, samples
    visual.global_.offheight, visual.global_.offwidth = frame_shape


def _is_ground(geom: Any) -> bool:
    """Return whether a geom of the world is an endless plane or the level ground that the robot starts on."""
    is_level = abs(geom.quat[1]) + abs(geom.quat[2]) < 1e-9
    is_low = float(geom.pos[2] + geom.size[2]) <= ON_FLOOR_M
    return geom.type == mujoco.mjtGeom.mjGEOM_PLANE or bool(is_level and is_low)


def key_light_position(target: Array, robot_size: float) -> Array:
    """Return where the shadow-casting light stands when the robot is at ``target``, (3,) in [m]."""
    return np.asarray(target + robot_size * KEY_LIGHT_OFFSET_SIZES)


def move_key_light(scene: Any, target: Array, robot_size: float) -> None:
    """Let the spot light of ``scene``, an ``MjvScene``, follow the robot."""
    for light in scene.lights[: scene.nlight]:
        if light.type == mujoco.mjtLightType.mjLIGHT_SPOT:
            light.pos = key_light_position(target, robot_size)
            light.dir = -KEY_LIGHT_OFFSET_SIZES / np.linalg.norm(KEY_LIGHT_OFFSET_SIZES)


def _set_lights(spec: Any, robot_size: float) -> None:
    for light in list(spec.lights):
        spec.delete(light)
    head = spec.visual.headlight
    head.active, head.ambient, head.diffuse, head.specular = 1, (0.40,) * 3, (0.26,) * 3, (0.0,) * 3
    spec.worldbody.add_light(
        name="fill",
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        dir=FILL_LIGHT_DIRECTION,
        ambient=(0.0,) * 3,
        diffuse=(0.26,) * 3,
        specular=(0.0,) * 3,
        castshadow=False,
    )
    spec.worldbody.add_light(
        name="key",
        type=mujoco.mjtLightType.mjLIGHT_SPOT,
        pos=key_light_position(np.zeros(3), robot_size),
        dir=-KEY_LIGHT_OFFSET_SIZES,
        cutoff=80.0,
        exponent=0.0,
        attenuation=(1.0, 0.0, 0.0),
        ambient=(0.0,) * 3,
        diffuse=(0.52,) * 3,
        specular=(0.35,) * 3,
        castshadow=True,
    )


def _add_surfaces(spec: Any) -> None:
    builtin, kind = mujoco.mjtBuiltin, mujoco.mjtTexture
    for texture in list(spec.textures):
        if texture.type == kind.mjTEXTURE_SKYBOX:
            spec.delete(texture)
    spec.add_texture(
        name="sky",
        type=kind.mjTEXTURE_SKYBOX,
        builtin=builtin.mjBUILTIN_GRADIENT,
        rgb1=HORIZON_RGBA[:3],
        rgb2=ZENITH_RGB,
        width=64,
        height=384,
    )
    for material, name, colors, per_metre in (
        (FLOOR_MATERIAL, "tiles", TILE_RGB, TILES_PER_METRE),
        (WOOD_MATERIAL, "wood", WOOD_RGB, BOARDS_PER_METRE),
    ):
        spec.add_texture(
            name=name,
            type=kind.mjTEXTURE_2D,
            builtin=builtin.mjBUILTIN_CHECKER,
            mark=mujoco.mjtMark.mjMARK_EDGE,
            rgb1=colors[0],
            rgb2=colors[1],
            markrgb=colors[2],
            width=256,
            height=256,
        )
        surface = spec.add_material(name=material, texuniform=True, texrepeat=per_metre, specular=0.0)
        surface.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = name
