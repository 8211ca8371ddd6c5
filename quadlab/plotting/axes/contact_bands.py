"""Which leg stands when, as bars under a time axis (the look of Gehring 2017, Fig. 3), planned beside actual."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from quadlab.analysis.trial_log import TrialLog, vectors
from quadlab.controllers.telemetry import LegMode
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.plotting.intervals import Interval, intervals_where, stance_intervals
from quadlab.plotting.leg_events import LegEvent, LegEventKind, leg_events
from quadlab.plotting.style import LEG_COLOURS, MEASURED, NEUTRAL
from quadlab.robots.legs import LEG_COUNT, LEGS

Bars = tuple[Sequence[Interval], ...]
"""Intervals of each leg, (4,), order ``LEGS``."""

_NONE: Bars = ((),) * LEG_COUNT
_PLANNED_HEIGHT, _ACTUAL_HEIGHT = 0.84, 0.42  # [rows]
_MARK_ROW = -0.36  # [rows] from the middle of the row: above the bar
_PLANNED_ALPHA = 0.28
_MARKS = {
    LegEventKind.EARLY_TOUCH_DOWN: ("v", "early"),
    LegEventKind.LATE_TOUCH_DOWN: ("^", "late"),
    LegEventKind.LOST_CONTACT: ("x", "contact lost"),
    LegEventKind.SKIPPED_SWING: ("s", "swing skipped"),
}


@dataclass(frozen=True)
class ContactBands:
    """What the bars of four legs show.

    Attributes:
        planned: stance of each leg according to the plan.
        actual: stance of each leg as it was; none if only a plan is shown.
        searching: when each leg searched the ground.
        events: marked at their legs.
    """

    planned: Bars
    actual: Bars = _NONE
    searching: Bars = _NONE
    events: tuple[LegEvent, ...] = ()


def planned_bands(schedule: ContactSchedule) -> ContactBands:
    """Return the bands of a schedule alone."""
    return ContactBands(tuple(stance_intervals(schedule, leg) for leg in range(LEG_COUNT)))


def recorded_bands(log: TrialLog, end_s: float) -> ContactBands:
    """Return the bands of a trial.

    Args:
        log: of the trial.
        end_s: until when the last tick holds in [s].
    """
    times = log.control.index.to_numpy(float)
    modes = vectors(log.control, "leg_mode")
    planned = vectors(log.control, "planned_contact") != 0.0
    return ContactBands(
        planned=_bars(times, planned, end_s),
        actual=_bars(times, modes == LegMode.STANCE, end_s),
        searching=_bars(times, modes == LegMode.SEARCH, end_s),
        events=leg_events(log.events),
    )


def draw_contact_bands(axes: Axes, bands: ContactBands) -> None:
    """Draw one row a leg, LF on top: planned stance pale, actual stance strong, search dark, events as marks."""
    for leg, colour in enumerate(LEG_COLOURS):
        only_plan = not bands.actual[leg]
        _draw_bars(axes, leg, bands.planned[leg], _PLANNED_HEIGHT, colour, 0.8 if only_plan else _PLANNED_ALPHA)
        _draw_bars(axes, leg, bands.actual[leg], _ACTUAL_HEIGHT, colour, 1.0)
        _draw_bars(axes, leg, bands.searching[leg], _ACTUAL_HEIGHT, MEASURED, 1.0)
    for kind, (marker, _) in _MARKS.items():
        found = [event for event in bands.events if event.kind is kind]
        rows = [event.leg + _MARK_ROW for event in found]
        axes.plot([event.time_s for event in found], rows, **_mark_style(marker))
    axes.set_yticks(range(LEG_COUNT), LEGS)
    axes.set_ylim(LEG_COUNT - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")


def contact_band_legend(bands: ContactBands) -> list[Artist]:
    """Return handles for what the bands show, events only of the kinds that happened."""
    handles: list[Artist] = [Patch(color=NEUTRAL, alpha=_PLANNED_ALPHA, lw=0, label="stance, planned")]
    if any(bands.actual):
        handles.append(Patch(color=NEUTRAL, lw=0, label="actual"))
    if any(bands.searching):
        handles.append(Patch(color=MEASURED, lw=0, label="searching"))
    for kind, (marker, label) in _MARKS.items():
        if any(event.kind is kind for event in bands.events):
            handles.append(Line2D([], [], **_mark_style(marker), label=label))
    return handles


def _bars(times: Array, flags: Array, end_s: float) -> Bars:
    return tuple(intervals_where(times, np.asarray(flags[:, leg], bool), end_s) for leg in range(LEG_COUNT))


def _draw_bars(axes: Axes, leg: int, bars: Sequence[Interval], height: float, colour: str, alpha: float) -> None:
    spans = [(bar.start_s, bar.duration_s) for bar in bars]
    axes.broken_barh(spans, (leg - 0.5 * height, height), facecolors=colour, alpha=alpha, linewidth=0)


def _mark_style(marker: str) -> dict[str, Any]:
    return {"ls": "", "marker": marker, "ms": 2.6, "mew": 0.7 if marker == "x" else 0.0, "color": MEASURED}
