"""The ground of a trial: heights under points, its profile in side views, its boxes in views from above."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from quadlab.geometry.polygons import convex_hull
from quadlab.geometry.rotations import Array, quat_to_matrix
from quadlab.plotting.style import GROUND
from quadlab.simulation.ground import Ground, TerrainBox

_PROFILE_PERIOD = 0.002  # [m]
_PARALLEL = 1e-12


def ground_heights(ground: Ground, points: Array) -> Array:
    """Return the height of the ground at ``points`` (n, 2) in [m], (n,) in [m]."""
    heights = np.full(len(points), ground.floor_height)
    for box in ground.boxes:
        heights = np.maximum(heights, _top_of(box, points))
    return heights


def ground_under_feet(ground: Ground, feet: Array, radius: float) -> Array:
    """Return the highest ground within a foot's reach, (n,) in [m]: a round foot stands on an edge beside its centre.

    Args:
        ground: heights are looked up at the centre and at four points of the circle.
        feet: (n, 2) in [m].
        radius: of the foot in [m].
    """
    offsets = radius * np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    highest: Array = np.max([ground_heights(ground, feet + offset) for offset in offsets], axis=0)
    return highest


def draw_profile(axes: Axes, ground: Ground, from_x: float, to_x: float, y: float) -> None:
    """Fill the ground below its section at ``y``, between two x, all in [m]."""
    x = np.arange(from_x, to_x, _PROFILE_PERIOD)
    heights = ground_heights(ground, np.column_stack([x, np.full_like(x, y)]))
    axes.fill_between(x, heights, axes.get_ylim()[0], color=GROUND, lw=0, zorder=0.6)


def draw_from_above(axes: Axes, ground: Ground) -> None:
    """Draw the outline of each box; what lies outside the limits of the axes stays outside."""
    for box in ground.boxes:
        signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
        corners = box.center + (signs * box.half_size) @ quat_to_matrix(box.quat_wxyz).T
        outline = convex_hull(corners[:, :2])
        axes.add_patch(Polygon(outline, facecolor=GROUND, edgecolor=GROUND, alpha=0.45, lw=0.6, zorder=0.6))


def _top_of(box: TerrainBox, points: Array) -> Array:
    """Return where a vertical line through each point leaves the box, (n,) in [m]; -inf where it misses it."""
    rotation = quat_to_matrix(box.quat_wxyz)
    origins = (np.pad(points, ((0, 0), (0, 1))) - box.center) @ rotation
    along = np.where(np.abs(rotation[2]) < _PARALLEL, _PARALLEL, rotation[2])
    limits = np.stack([(-box.half_size - origins) / along, (box.half_size - origins) / along])
    enter, leave = limits.min(axis=0).max(axis=1), limits.max(axis=0).min(axis=1)
    return np.where(enter <= leave, leave, -np.inf)
