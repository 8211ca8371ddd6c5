"""The feet: their paths over the terrain from the side, and their heights over time (Gehring 2017, Fig. 6)."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quadlab.analysis.trial_log import leg_vectors
from quadlab.geometry.rotations import Array
from quadlab.plotting.axes.terrain import draw_profile, ground_under_feet
from quadlab.plotting.axes.time_rows import BANDS_HEIGHT, finish_time_rows, legend_above
from quadlab.plotting.style import GROUND, LEG_COLOURS, TEXT_WIDTH, paper_style
from quadlab.plotting.trial_view import TrialView
from quadlab.robots.legs import LEG_COUNT, LEGS, leg_index

SIDES = (("LF", "LH"), ("RF", "RH"))
_SIDE_HEIGHT, _TIME_HEIGHT = 0.75, 0.62  # [in]
_HEADROOM = 0.02  # [m] below and above the feet


@paper_style()
def feet_figure(view: TrialView) -> Figure:
    """Return the feet of each side from the side, and the height of every foot over time."""
    heights = [_SIDE_HEIGHT] * 2 + [_TIME_HEIGHT] * LEG_COUNT + [BANDS_HEIGHT]
    figure = Figure((TEXT_WIDTH, sum(heights) + 0.9), layout="constrained")
    rows = figure.subplots(len(heights), height_ratios=heights)
    for axes, legs in zip(rows, SIDES, strict=False):
        draw_side_view(axes, view, legs)
        legend_above(axes)
    rows[0].tick_params(labelbottom=False)
    rows[1].set_xlabel("x [m]")
    for leg, axes in enumerate(rows[2:-1]):
        draw_foot_height(axes, view, leg)
    legend_above(rows[2])
    finish_time_rows(view, rows[2:-1], rows[-1])
    figure.align_ylabels()
    return figure


def draw_side_view(axes: Axes, view: TrialView, legs: Sequence[str]) -> None:
    """Draw the paths of ``legs`` in x and z over the ground below their mean y; references are pale."""
    numbers = [leg_index(leg) for leg in legs]
    feet, references = _positions(view)
    _set_height_limits(axes, feet)
    for leg in numbers:
        axes.plot(*references[:, leg, ::2].T, color=LEG_COLOURS[leg], lw=2.2, alpha=0.3)
        axes.plot(*feet[:, leg, ::2].T, color=LEG_COLOURS[leg], label=LEGS[leg])
    low, high = feet[:, :, 0].min() - 0.05, feet[:, :, 0].max() + 0.05
    axes.set_xlim(low, high)
    draw_profile(axes, view.ground, low, high, float(feet[:, numbers, 1].mean()))
    axes.set_ylabel("z [m]")


def draw_foot_height(axes: Axes, view: TrialView, leg: int) -> None:
    """Draw the height of a foot's contact point, its reference in swing, and the ground below it."""
    feet, references = _positions(view)
    _set_height_limits(axes, feet)
    ground = ground_under_feet(view.ground, feet[:, leg, :2], view.foot_radius)
    axes.fill_between(view.times_s, ground, axes.get_ylim()[0], color=GROUND, lw=0, label="ground under the foot")
    axes.plot(view.times_s, references[:, leg, 2], color=LEG_COLOURS[leg], lw=2.2, alpha=0.35, label="reference")
    axes.plot(view.times_s, feet[:, leg, 2], color=LEG_COLOURS[leg], label="measured")
    axes.set_ylabel(f"{LEGS[leg]} z [m]")


def _positions(view: TrialView) -> tuple[Array, Array]:
    feet = leg_vectors(view.log.control, "foot_position")
    return feet, leg_vectors(view.log.control, "foot_position_reference")


def _set_height_limits(axes: Axes, feet: Array) -> None:
    axes.set_ylim(float(feet[:, :, 2].min()) - _HEADROOM, float(feet[:, :, 2].max()) + _HEADROOM)
