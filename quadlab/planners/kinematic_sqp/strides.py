"""From waypoints and schedule to a chain of cycles: which are planned one by one and which once and repeated."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from quadlab.gaits.schedule import BoolArray, ContactSchedule
from quadlab.geometry.rotations import Array, rotation_2d
from quadlab.planners.problem import PlanningProblem, Waypoints
from quadlab.robots.legs import LEG_COUNT

_TIME_TOLERANCE = 1e-6  # [s]
_POSE_TOLERANCE = 1e-9  # [m], [rad]
_FEWEST_OF_REST = 2
_LONGEST_STRETCH = 2.0  # how many times longer than those of steps the sample periods of a rest may be


@dataclass(frozen=True)
class Cycle:
    """A part of the motion between two neighbouring waypoints, divided into samples.

    Attributes:
        periods_s: distances of its samples, (samples,) in [s].
        increment: commanded displacement x, y in [m] and turn in [rad], seen from where it begins, (3,).
        contacts: which legs stand between neighbouring samples, (samples, 4): those that the schedule has standing in
            the middle between them, so that a switch moves by at most half a sample period.
        moves: whether a leg swings in it; a cycle in which none does is a rest.
        periodic: whether it ends in the joint positions in which it begins, Eq. (10).
        repeats: how often it runs.
    """

    periods_s: Array
    increment: Array
    contacts: BoolArray
    moves: bool
    periodic: bool = False
    repeats: int = 1

    @property
    def duration_s(self) -> float:
        """Length of one run in [s]."""
        return float(self.periods_s.sum())


def cycle_chain(problem: PlanningProblem, samples_per_cycle: int, samples_per_rest: int) -> tuple[Cycle, ...]:
    """Return the cycles of a well-formed problem in order of time.

    Every interval between waypoints is a cycle. Of neighbouring cycles that are alike the first and, if a rest
    follows, the last are planned by themselves; those between are one periodic cycle that is repeated. The first
    cycle after another motion that is planned by itself need not be planned twice: walk, then periodic trot is the
    transition of Gehring 2017, Fig. 3c. A schedule that does not end in a rest ends in a periodic cycle: the paper's
    problem of two cycles.

    Args:
        problem: waypoints at the borders of the cycles and contact schedule.
        samples_per_cycle: samples of a cycle with steps.
        samples_per_rest: largest number of samples of a rest; its samples are not closer than those of its neighbour.
    """
    waypoints = _to_the_end(problem.waypoints, problem.schedule.duration_s)
    cycles = [
        _cycle(waypoints, problem.schedule, index, samples_per_cycle) for index in range(len(waypoints.times_s) - 1)
    ]
    rested = [_thinned(cycles, index, samples_per_rest) for index in range(len(cycles))]
    return tuple(_repeated(list(_runs(rested))))


def _to_the_end(waypoints: Waypoints, duration_s: float) -> Waypoints:
    """Return waypoints that reach to the end of the schedule, where the goal is held."""
    if duration_s - waypoints.times_s[-1] <= _TIME_TOLERANCE:
        return waypoints
    return Waypoints(np.append(waypoints.times_s, duration_s), np.vstack([waypoints.poses, waypoints.poses[-1:]]))


def _cycle(waypoints: Waypoints, schedule: ContactSchedule, index: int, samples: int) -> Cycle:
    start, end = (float(time) for time in waypoints.times_s[index : index + 2])
    before, after = waypoints.poses[index : index + 2]
    increment = np.append(rotation_2d(float(before[2])).T @ (after[:2] - before[:2]), after[2] - before[2])
    middles = start + (end - start) * (np.arange(samples) + 0.5) / samples
    contacts = np.array([schedule.contacts_at(float(time)) for time in middles])
    return Cycle(np.full(samples, (end - start) / samples), increment, contacts, moves=not contacts.all())


def _thinned(cycles: Sequence[Cycle], index: int, most: int) -> Cycle:
    """Return a cycle; a rest gets about the sample period of the steps beside it, and at most ``most`` samples.

    In a rest too long for that the robot waits: after its last sample if the motion ends there, else within one long
    interval, the second one at the start of the motion and the middle one elsewhere.
    """
    cycle = cycles[index]
    if cycle.moves:
        return cycle
    beside = [float(other.periods_s[0]) for other in cycles[max(index - 1, 0) : index + 2] if other.moves]
    duration = cycle.duration_s
    period = min(beside, default=duration / most)
    count = int(np.clip(round(duration / period), _FEWEST_OF_REST, most))
    periods = np.full(count, duration / count)
    if duration > _LONGEST_STRETCH * count * period:
        periods = np.full(count, period)
        if index + 1 < len(cycles):
            periods[1 if index == 0 else count // 2] += duration - count * period
    return replace(cycle, periods_s=periods, contacts=np.ones((count, LEG_COUNT), dtype=bool))


def _runs(cycles: Sequence[Cycle]) -> Iterator[list[Cycle]]:
    """Yield cycles that are alike and follow each other."""
    run = [cycles[0]]
    for before, cycle in pairwise(cycles):
        if not _alike(before, cycle):
            yield run
            run = []
        run.append(cycle)
    yield run


def _alike(one: Cycle, other: Cycle) -> bool:
    return (
        abs(one.duration_s - other.duration_s) < _TIME_TOLERANCE
        and np.array_equal(one.contacts, other.contacts)
        and bool(np.abs(one.increment - other.increment).max() < _POSE_TOLERANCE)
    )


def _repeated(runs: Sequence[list[Cycle]]) -> Iterator[Cycle]:
    """Yield the cycles of all runs, the middle of each run as one periodic cycle."""
    single = False  # whether the cycle before has steps and is planned by itself
    for index, run in enumerate(runs):
        if not run[0].moves:
            yield from run
            single = False
            continue
        rest_follows = index + 1 < len(runs) and not runs[index + 1][0].moves
        entry, leaving = int(not single), int(rest_follows)
        middle = len(run) - entry - leaving
        if middle < 1:
            yield from run
            single = True
            continue
        yield from run[:entry]
        yield replace(run[entry], periodic=True, repeats=middle)
        yield from run[entry + middle :]
        single = bool(leaving)
