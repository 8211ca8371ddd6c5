"""What is commanded over cycles with steps and the rests beside them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.command import compose
from quadlab.planners.kinematic_sqp.grid import CycleSpan, SampleGrid


@dataclass(frozen=True)
class CommandedSpan:
    """A part of the motion whose displacement and turn are commanded.

    Attributes:
        first, last: samples with which it begins and ends.
        heading: commanded heading at its beginning in [rad].
        increment: commanded displacement x, y in [m] and turn in [rad], seen from where it begins, (3,).
        periodic: whether its cycle with steps ends in the joint positions in which it begins.
    """

    first: int
    last: int
    heading: float
    increment: Array
    periodic: bool


def commanded_spans(grid: SampleGrid) -> list[CommandedSpan]:
    """Return a span for each cycle with steps and the rests that belong to it; for each cycle if none has steps.

    The rests before the first and after any cycle with steps belong to it, with what is commanded in them: a robot that
    stands beside its path when it plans again has its way back to it in the rest that is left before the first step.
    """
    moving = [number for number, span in enumerate(grid.spans) if span.cycle.moves]
    if not moving:
        return [_commanded([span], span) for span in grid.spans]
    begins = [0, *moving[1:]]
    ends = [*moving[1:], len(grid.spans)]
    return [_commanded(grid.spans[b:e], grid.spans[n]) for n, b, e in zip(moving, begins, ends, strict=True)]


def _commanded(spans: Sequence[CycleSpan], stepping: CycleSpan) -> CommandedSpan:
    """Return neighbouring cycles as one; ``stepping`` is the one with steps."""
    increment = np.zeros(3)
    for span in spans:
        increment = compose(increment, span.cycle.increment)
    return CommandedSpan(spans[0].first, spans[-1].last, spans[0].heading, increment, stepping.cycle.periodic)
