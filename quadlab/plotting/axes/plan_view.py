"""A plan from above (the look of Winkler 2017, Fig. 5), and over it what the robot did."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.plotting.placed_plan import PlacedPlan, SupportArea
from quadlab.plotting.style import COP, LEG_COLOURS, MEASURED, NEUTRAL
from quadlab.robots.legs import LEG_COUNT, LEGS

_MARGIN = 0.08  # [m] round what is drawn
_AREA_ALPHA, _EDGE_ALPHA, _LINE_ALPHA = 0.05, 0.2, 0.45
_FOOTHOLD: dict[str, Any] = {"ls": "", "marker": "o", "mfc": "w", "ms": 4.4, "mew": 0.9}
_STANCE: dict[str, Any] = {"ls": "", "marker": "o", "ms": 2.3, "mew": 0.0}
_COM_WIDTH = 1.8  # [pt]
COP_DOT: dict[str, Any] = {"ls": "", "marker": ".", "ms": 2.6, "mew": 0.0, "color": COP}
"""How samples of the CoP look."""


def draw_placed_plan(axes: Axes, plan: PlacedPlan) -> None:
    """Draw support areas, initial stance (squares), footholds (circles), CoP, and the CoM in the colour of its swing.

    Phases have the colour of the first leg that swings in them, grey if all stand.
    """
    for support in plan.supports:
        _draw_support(axes, support)
    draw_by_phase(axes, plan.com, plan.contacts)
    axes.plot(*plan.cop.T, **COP_DOT, zorder=3.8)
    for colour, footholds in zip(LEG_COLOURS, plan.footholds, strict=True):
        axes.plot(*footholds[:1].T, **{**_FOOTHOLD, "marker": "s"}, color=colour, zorder=4)
        axes.plot(*footholds[1:].T, **_FOOTHOLD, color=colour, zorder=4)


def draw_actual(axes: Axes, com: Array, stance_points: Sequence[Array]) -> None:
    """Draw where the robot was.

    Args:
        axes: to draw into.
        com: centre of mass, (n, 2) in [m].
        stance_points: of each leg, (k, 2) in [m].
    """
    axes.plot(*com.T, color=MEASURED, lw=0.8, zorder=5)
    for colour, points in zip(LEG_COLOURS, stance_points, strict=True):
        axes.plot(*points.T, **_STANCE, color=colour, zorder=5)


def plan_view_legend(*, actual: bool) -> list[Artist]:
    """Return handles for a plan from above, with or without what the robot did."""
    legs = [Line2D([], [], **_FOOTHOLD, color=LEG_COLOURS[leg], label=LEGS[leg]) for leg in range(LEG_COUNT)]
    rest = [
        Line2D([], [], **{**_FOOTHOLD, "marker": "s"}, color=NEUTRAL, label="initial stance"),
        Line2D([], [], **_FOOTHOLD, color=NEUTRAL, label="foothold"),
        Line2D([], [], color=NEUTRAL, lw=_COM_WIDTH, label="CoM, coloured by swing"),
        Line2D([], [], **COP_DOT, label="CoP"),
    ]
    if actual:
        rest += [
            Line2D([], [], **_STANCE, color=NEUTRAL, label="actual stance"),
            Line2D([], [], color=MEASURED, lw=0.8, label="actual CoM"),
        ]
    return [*legs, *rest]


def frame_points(axes: Axes, points: Sequence[Array]) -> None:
    """Make both axes equal and large enough for all ``points``, each (n, 2) in [m]."""
    everything = np.concatenate([array for array in points if len(array)])
    low, high = everything.min(axis=0) - _MARGIN, everything.max(axis=0) + _MARGIN
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")


def extent_of(points: Sequence[Array]) -> tuple[float, float]:
    """Return width and height in [m] of what ``frame_points`` makes visible."""
    width, height = np.ptp(np.concatenate(list(points)), axis=0) + 2.0 * _MARGIN
    return float(width), float(height)


def plan_points(plan: PlacedPlan) -> list[Array]:
    """Return everything that a view of ``plan`` must contain, each (n, 2) in [m]."""
    return [plan.com, plan.cop, *plan.footholds]


def phase_colour(contacts: BoolArray) -> str:
    """Return the colour of a phase in which the legs ``contacts``, (4,), stand."""
    swinging = np.flatnonzero(~contacts)
    return LEG_COLOURS[swinging[0]] if len(swinging) else NEUTRAL


def phase_spans(contacts: BoolArray) -> list[tuple[int, int]]:
    """Return first sample of each phase and of the one after it, given the flags of all samples, (n, 4)."""
    switches = np.flatnonzero(np.any(contacts[1:] != contacts[:-1], axis=1)) + 1
    return list(pairwise([0, *switches.tolist(), len(contacts) - 1]))


def draw_by_phase(axes: Axes, points: Array, contacts: BoolArray) -> None:
    """Draw a line through ``points``, (n, 2), in the colours of the phases that ``contacts``, (n, 4), are in."""
    pieces = [(points[begin : end + 1], contacts[begin]) for begin, end in phase_spans(contacts)]
    colours = [phase_colour(flags) for _, flags in pieces]
    lines = LineCollection([piece for piece, _ in pieces], colors=colours, linewidths=_COM_WIDTH, zorder=3.5)
    axes.add_collection(lines)


def _draw_support(axes: Axes, support: SupportArea) -> None:
    colour = phase_colour(support.contacts)
    if len(support.corners) > 2:
        axes.add_patch(Polygon(support.corners, facecolor=colour, edgecolor="none", alpha=_AREA_ALPHA, zorder=1))
        axes.add_patch(Polygon(support.corners, fill=False, edgecolor=colour, alpha=_EDGE_ALPHA, lw=0.4, zorder=1))
    else:
        axes.plot(*support.corners.T, color=colour, alpha=_LINE_ALPHA, lw=1.0, zorder=1)
