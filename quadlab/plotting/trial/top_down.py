"""The trial from above: the plan as it was made, and as it followed the robot, with what the robot did."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.analysis.trial_log import leg_vectors, vectors
from quadlab.geometry.rotations import Array
from quadlab.plotting.axes.plan_view import (
    draw_actual,
    draw_placed_plan,
    extent_of,
    frame_points,
    plan_points,
    plan_view_legend,
)
from quadlab.plotting.axes.pushes import draw_push_arrows
from quadlab.plotting.axes.terrain import draw_from_above
from quadlab.plotting.placed_plan import PlacedPlan, in_plan_frame, place_plan
from quadlab.plotting.style import TEXT_WIDTH, paper_style
from quadlab.plotting.trial_view import TrialView
from quadlab.robots.legs import LEG_COUNT

_SHORTEST_STANCE_S = 0.01
_ARROW_SHARE = 0.24  # of the shorter side of the view, for the strongest push
_LARGEST_HEIGHT = 4.0  # [in] of a panel
_SIDE_BY_SIDE = 2.2  # panels that are less elongated than this stand beside each other


@paper_style()
def top_down_figure(view: TrialView) -> Figure:
    """Return the plan in its own frame and, in the world, the plan that followed the robot and what was measured."""
    planned, followed = in_plan_frame(view.plan), aligned_plan(view)
    shape = extent_of(plan_points(planned)), extent_of(world_points(view, followed))
    stacked = min(extent[0] / extent[1] for extent in shape) > _SIDE_BY_SIDE
    figure = Figure(_size(shape, stacked), layout="constrained")
    rows, columns = (2, 1) if stacked else (1, 2)
    ratios = [extent[1] / extent[0] for extent in shape] if stacked else None
    above, below = figure.subplots(rows, columns, squeeze=False, height_ratios=ratios).ravel()
    draw_placed_plan(above, planned)
    frame_points(above, plan_points(planned))
    above.set_title("(a) plan, in its own frame", loc="left")
    draw_world_view(below, view, followed)
    if stacked:
        _share_x_limits(above, below)
    below.set_title("(b) trial, in the world: the plan as it followed the robot", loc="left")
    figure.legend(handles=plan_view_legend(actual=True), loc="outside lower center", ncols=5)
    return figure


def draw_world_view(axes: Axes, view: TrialView, followed: PlacedPlan) -> None:
    """Draw terrain, the plan that followed the robot, CoM and stance points of the robot, and pushes."""
    draw_from_above(axes, view.ground)
    draw_placed_plan(axes, followed)
    draw_actual(axes, vectors(view.log.control, "com")[:, :2], stance_points(view))
    points = world_points(view, followed)
    draw_push_arrows(axes, view.pushes, _ARROW_SHARE * min(extent_of(points)))
    frame_points(axes, points)


def aligned_plan(view: TrialView) -> PlacedPlan:
    """Return the plan in the world, where the controller saw it when it came to pass."""
    plan_times = view.log.control["plan_time_s"].to_numpy(float)
    poses = vectors(view.log.control, "plan_pose")

    def pose_at(plan_time_s: float) -> Array:
        tick = min(int(np.searchsorted(plan_times, plan_time_s)), len(poses) - 1)
        pose: Array = poses[tick]
        return pose

    return place_plan(view.plan, pose_at, min(float(plan_times[-1]), view.plan.duration_s))


def stance_points(view: TrialView) -> list[Array]:
    """Return where each leg touched down, (k, 2) in [m]; contacts of an instant do not count."""
    feet = leg_vectors(view.log.control, "foot_position")[:, :, :2]
    points = []
    for leg in range(LEG_COUNT):
        starts = [bar.start_s for bar in view.bands.actual[leg] if bar.duration_s > _SHORTEST_STANCE_S]
        points.append(feet[np.searchsorted(view.times_s, starts), leg])
    return points


def world_points(view: TrialView, followed: PlacedPlan) -> list[Array]:
    """Return everything that the view of the world must contain, each (n, 2) in [m]."""
    arrows = [np.array([push.com_position, push.com_position]) for push in view.pushes]
    return [*plan_points(followed), vectors(view.log.control, "com")[:, :2], *stance_points(view), *arrows]


def _share_x_limits(above: Axes, below: Axes) -> None:
    limits = [axes.get_xlim() for axes in (above, below)]
    for axes in (above, below):
        axes.set_xlim(min(low for low, _ in limits), max(high for _, high in limits))


def _size(extents: Sequence[tuple[float, float]], stacked: bool) -> tuple[float, float]:
    width = TEXT_WIDTH - 0.6 if stacked else 0.5 * TEXT_WIDTH - 0.6
    heights = [min(_LARGEST_HEIGHT, width * extent[1] / extent[0]) for extent in extents]
    return TEXT_WIDTH, (sum(heights) + 1.5) if stacked else max(heights) + 0.9
