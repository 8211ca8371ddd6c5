"""Gaits as data: patterns of stance and swing, one column a sample, as drawn in Gehring 2017, Fig. 3."""

from typing import Annotated

import numpy as np
from pydantic import Field, field_validator

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.errors import ConfigurationError
from quadlab.gaits.schedule import BoolArray, ContactSchedule
from quadlab.robots.legs import LEGS

STANCE, SWING = "#", "."
_ROUNDING = 1e-9  # of a number of strides


class CycleConfig(StrictModel):
    """One repeated stride.

    Attributes:
        stride_duration_s: duration of the whole pattern in [s].
        pattern: per leg a row of '#' (stance) and '.' (swing), all of one length; columns are equally long.
        strides: how often it repeats; null (last cycle only) fills the trial.
    """

    stride_duration_s: Positive
    pattern: dict[str, str]
    strides: Annotated[int, Field(ge=1)] | None = None

    @field_validator("pattern")
    @classmethod
    def _check_pattern(cls, pattern: dict[str, str]) -> dict[str, str]:
        if set(pattern) != set(LEGS):
            raise ValueError(f"needs one row for each of {', '.join(LEGS)}; has {', '.join(sorted(pattern))}")
        if len({len(row) for row in pattern.values()}) != 1 or not pattern[LEGS[0]]:
            raise ValueError("rows must have the same number of columns, at least one")
        if any(set(row) - {STANCE, SWING} for row in pattern.values()):
            raise ValueError(f"rows hold only '{STANCE}' (stance) and '{SWING}' (swing)")
        return pattern

    def contacts(self) -> BoolArray:
        """Return the pattern as flags, (columns, 4)."""
        return np.array([[cell == STANCE for cell in self.pattern[leg]] for leg in LEGS]).T


class GaitConfig(StrictModel):
    """A gait: standing, then cycles one after the other, then standing.

    Attributes:
        name: name of the gait in results.
        initial_stance_s: four-leg stance before the first stride in [s].
        final_stance_s: four-leg stance after the last stride in [s].
        cycles: at least one; the last one without ``strides`` repeats until the duration is used up.
    """

    name: str
    initial_stance_s: NonNegative
    final_stance_s: NonNegative
    cycles: Annotated[tuple[CycleConfig, ...], Field(min_length=1)]

    @field_validator("cycles")
    @classmethod
    def _only_last_is_open(cls, cycles: tuple[CycleConfig, ...]) -> tuple[CycleConfig, ...]:
        if any(cycle.strides is None for cycle in cycles[:-1]):
            raise ValueError("only the last cycle may leave 'strides' empty")
        return cycles


def stride_counts(gait: GaitConfig, duration_s: float) -> list[int]:
    """Return how often each cycle runs in a trial of ``duration_s`` in [s].

    Raises:
        ConfigurationError: if the duration does not hold all strides, and one of the last cycle.
    """
    last = gait.cycles[-1]
    counts = [cycle.strides or 1 for cycle in gait.cycles]
    strides_s = sum(count * cycle.stride_duration_s for count, cycle in zip(counts, gait.cycles, strict=True))
    shortest_s = gait.initial_stance_s + strides_s + gait.final_stance_s
    to_spare = (duration_s - shortest_s) / last.stride_duration_s + _ROUNDING
    if to_spare < 0.0:
        raise ConfigurationError(
            f"duration_s: {duration_s:g} s is too short for gait '{gait.name}'; "
            f"{_strides(sum(counts))} {shortest_s:g} s with the stances before and after"
        )
    return counts if last.strides else [*counts[:-1], 1 + int(to_spare)]


def _strides(count: int) -> str:
    return "one stride needs" if count == 1 else f"its {count} strides need"


def stride_times(gait: GaitConfig, duration_s: float) -> list[float]:
    """Return the start of every stride and the end of the last one, in [s]."""
    times = [gait.initial_stance_s]
    for cycle, count in zip(gait.cycles, stride_counts(gait, duration_s), strict=True):
        times += [times[-1] + cycle.stride_duration_s * (i + 1) for i in range(count)]
    return times


def contact_schedule(gait: GaitConfig, duration_s: float) -> ContactSchedule:
    """Return the contact schedule of a trial: standing, all strides that fit, standing to the end.

    Args:
        gait: the gait.
        duration_s: length of the schedule in [s]; what the strides leave over is stance at the end.

    Raises:
        ConfigurationError: if the duration does not hold the strides, see ``stride_counts``.
    """
    standing = np.ones((1, len(LEGS)), dtype=bool)
    rows, durations = [standing], [gait.initial_stance_s]
    for cycle, count in zip(gait.cycles, stride_counts(gait, duration_s), strict=True):
        contacts = cycle.contacts()
        rows.append(np.tile(contacts, (count, 1)))
        durations += [cycle.stride_duration_s / len(contacts)] * (count * len(contacts))
    rest = max(duration_s - sum(durations), gait.final_stance_s)
    return _merge(np.concatenate([*rows, standing]), np.array([*durations, rest]))


def _merge(contacts: BoolArray, durations_s: np.ndarray) -> ContactSchedule:
    """Join neighbouring phases with the same contacts and drop empty ones."""
    keep = durations_s > 1e-9
    contacts, durations_s = contacts[keep], durations_s[keep]
    starts = np.flatnonzero(np.r_[True, (contacts[1:] != contacts[:-1]).any(axis=1)])
    return ContactSchedule(np.add.reduceat(durations_s, starts), contacts[starts])
