"""Textures as colours of whole triangles, so that meshes can be made small afterwards."""

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from quadlab.geometry.rotations import Array
from quadlab.simulation.rendering.collada import ColladaPart
from quadlab.simulation.rendering.mesh import TriangleMesh

PALETTE_SIZE = 32
SAME_COLOR_DISTANCE = 0.25
"""Colours closer than this in RGB (0 to 1 each) become the more frequent of the two."""


def colored_meshes(part: ColladaPart) -> list[TriangleMesh]:
    """Return the part as meshes of one colour; a texture becomes a few clearly different colours.

    Each triangle gets the colour at the centre of its texture coordinates. A texture file that does not exist leaves
    the mesh without a colour, as a material without a colour does.
    """
    diffuse = part.diffuse
    if diffuse.texture is None or part.texture_coordinates is None or not diffuse.texture.is_file():
        return [_mesh(part.corners, diffuse.rgba)]
    with Image.open(diffuse.texture) as image:
        quantized = image.convert("RGB").quantize(PALETTE_SIZE, dither=Image.Dither.NONE)
    palette = np.array(quantized.getpalette() or [], dtype=float).reshape(-1, 3) / 255.0
    sampled = _pixels_at(np.asarray(quantized), part.texture_coordinates.mean(axis=1))
    choice = _representatives(palette, sampled)[sampled]
    return [_mesh(part.corners[choice == index], np.array([*palette[index], 1.0])) for index in np.unique(choice)]


def _representatives(palette: Array, sampled: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return for each palette entry the entry that stands for it, (k,): itself or a more frequent similar one."""
    representatives = np.arange(len(palette))
    chosen: list[int] = []
    for index in np.argsort(-np.bincount(sampled, minlength=len(palette)), kind="stable"):
        distances = [float(np.linalg.norm(palette[index] - palette[other])) for other in chosen]
        if distances and min(distances) < SAME_COLOR_DISTANCE:
            representatives[index] = chosen[int(np.argmin(distances))]
        else:
            chosen.append(int(index))
    return representatives


def _pixels_at(pixels: NDArray[np.uint8], coordinates: Array) -> NDArray[np.intp]:
    """Return the palette index at each texture coordinate, (m,), for (m, 2) with the origin at the lower left."""
    height, width = pixels.shape
    column = np.floor(coordinates[:, 0] * width).astype(int) % width
    row = np.floor((1.0 - coordinates[:, 1]) * height).astype(int) % height
    return np.asarray(pixels[row, column], np.intp)


def _mesh(corners: Array, rgba: Array | None) -> TriangleMesh:
    return TriangleMesh(corners.reshape(-1, 3), np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3), rgba)
