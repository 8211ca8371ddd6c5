"""Pushes: spans of a time axis and arrows on the ground."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from quadlab.analysis.trial_log import TrialLog, vectors
from quadlab.geometry.rotations import Array
from quadlab.plotting.intervals import Interval, intervals_where
from quadlab.plotting.style import PUSH

_SPAN_ALPHA = 0.35
_LABEL_GAP = 3.0  # [pt]
_ARROW = {
    "arrowstyle": "-|>,head_width=0.16,head_length=0.3",
    "color": PUSH,
    "lw": 1.4,
    "shrinkA": 0,
    "shrinkB": 0,
}


@dataclass(frozen=True)
class RecordedPush:
    """One push as the log has it.

    Attributes:
        interval: when.
        force: mean over the interval in world axes, (3,) in [N].
        com_position: where the robot was when it began, (2,) in [m].
    """

    interval: Interval
    force: Array
    com_position: Array

    @property
    def label(self) -> str:
        """Magnitude and impulse, e.g. "120 N, 18 N s"."""
        size = float(np.linalg.norm(self.force))
        return f"{size:.0f} N, {size * self.interval.duration_s:.0f} N s"


def recorded_pushes(log: TrialLog, end_s: float) -> tuple[RecordedPush, ...]:
    """Return the pushes of a trial; neighbouring ticks with a force are one push.

    Args:
        log: of the trial.
        end_s: until when the last tick holds in [s].
    """
    times = log.state.index.to_numpy(float)
    forces, com = vectors(log.state, "push_force"), vectors(log.control, "com")
    found = []
    for interval in intervals_where(times, np.any(forces != 0.0, axis=1), end_s):
        ticks = (times >= interval.start_s) & (times < interval.end_s)
        found.append(RecordedPush(interval, forces[ticks].mean(axis=0), com[ticks][0, :2]))
    return tuple(found)


def shade_pushes(axes: Axes, pushes: Sequence[RecordedPush]) -> None:
    """Shade the time of each push."""
    for push in pushes:
        axes.axvspan(*push.interval, color=PUSH, alpha=_SPAN_ALPHA, lw=0, zorder=0.5)


def draw_push_arrows(axes: Axes, pushes: Sequence[RecordedPush], longest: float) -> None:
    """Draw an arrow from the robot's place into the direction of each push.

    Args:
        axes: to draw into.
        pushes: lengths of their arrows are to scale.
        longest: length for the strongest push in [m].
    """
    largest = max((float(np.linalg.norm(push.force[:2])) for push in pushes), default=0.0)
    for push in pushes:
        if not push.force[:2].any():
            continue
        tip_x, tip_y = push.com_position + longest / largest * push.force[:2]
        start_x, start_y = push.com_position
        axes.annotate("", (tip_x, tip_y), (start_x, start_y), arrowprops=_ARROW, zorder=6)
        _label_tip(axes, push, (tip_x, tip_y))


def push_legend(pushes: Sequence[RecordedPush]) -> list[Artist]:
    """Return a handle for the spans, if there are any."""
    return [Patch(color=PUSH, alpha=_SPAN_ALPHA, lw=0, label="push")] if pushes else []


def _label_tip(axes: Axes, push: RecordedPush, tip: tuple[float, float]) -> None:
    """Write the size of the push beyond the tip of its arrow, readable over what lies below."""
    x, y = push.force[:2] / np.linalg.norm(push.force[:2])
    sideways = abs(x) > abs(y)
    text = axes.annotate(
        push.label,
        tip,
        xytext=(_LABEL_GAP * x, _LABEL_GAP * y),
        textcoords="offset points",
        color=PUSH,
        ha=("left" if x > 0.0 else "right") if sideways else "center",
        va="center" if sideways else ("bottom" if y > 0.0 else "top"),
        zorder=7,
    )
    text.set_path_effects([withStroke(linewidth=2.0, foreground="w")])
