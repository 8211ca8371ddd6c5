"""What the log says happened to a leg, e.g. an early touch-down."""

from dataclasses import dataclass
from enum import Enum

import pandas as pd

from quadlab.robots.legs import LEGS, leg_index


class LegEventKind(Enum):
    """The kinds of events that figures mark; values are the beginnings of their messages behind the leg's name."""

    EARLY_TOUCH_DOWN = "early touch-down"
    LATE_TOUCH_DOWN = "late"
    LOST_CONTACT = "lost contact"
    SKIPPED_SWING = "swing skipped"


@dataclass(frozen=True)
class LegEvent:
    """Something that happened to a leg.

    Attributes:
        time_s: in [s].
        leg: number of the leg.
        kind: what it was.
    """

    time_s: float
    leg: int
    kind: LegEventKind


def leg_events(events: pd.DataFrame) -> tuple[LegEvent, ...]:
    """Return the events of legs among those of a log (``TrialLog.events``)."""
    times = events.index.to_numpy(float).tolist()
    found = (leg_event(time_s, message) for time_s, message in zip(times, events["message"], strict=True))
    return tuple(event for event in found if event is not None)


def leg_event(time_s: float, message: str) -> LegEvent | None:
    """Return what ``message`` says about a leg; None if it is about something else or of no kind that is marked."""
    name, _, what = message.partition(" ")
    kind = next((kind for kind in LegEventKind if what.startswith(kind.value)), None)
    return LegEvent(time_s, leg_index(name), kind) if name in LEGS and kind is not None else None
