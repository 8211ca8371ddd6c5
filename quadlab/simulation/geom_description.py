"""Shapes fixed to bodies, described without the simulator, for whoever draws them."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from quadlab.geometry.rotations import Array

GeomKind = Literal["box", "sphere", "cylinder", "capsule", "mesh", "plane"]
Rgba = tuple[float, float, float, float]


@dataclass(frozen=True)
class GeomDescription:
    """One geometric shape that is fixed to a body.

    Attributes:
        body: name of the body, "world" for the surroundings.
        kind: shape; cylinders and capsules lie along z, planes have their normal along z.
        position: in the body frame, (3,) in [m].
        quat_wxyz: unit quaternion that turns components of the shape into components of the body, (4,).
        size: (3,) in [m]: half edges of a box; radius of a sphere; radius and half length (without the caps) of a
            cylinder or capsule; half edges x, y of a plane, 0 for endless; not used for a mesh.
        rgba: colour, components in [0, 1].
        vertices: of a mesh, (n, 3) in [m].
        faces: of a mesh, (m, 3) indices into ``vertices``.
    """

    body: str
    kind: GeomKind
    position: Array
    quat_wxyz: Array
    size: Array
    rgba: Rgba
    vertices: Array | None = None
    faces: NDArray[np.integer[Any]] | None = None
