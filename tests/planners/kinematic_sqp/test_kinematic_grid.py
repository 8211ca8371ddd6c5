"""Cycles and samples: what repeats, who stands when, who may carry."""

from dataclasses import replace

import numpy as np
import pytest
from kinematic_cases import PAPER_MOTIONS, WHOLE_MOTIONS, Motion, beside_path, problem

from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array
from quadlab.planners.command import compose
from quadlab.planners.kinematic_sqp.grid import SampleGrid, sample_grid
from quadlab.planners.kinematic_sqp.objectives.commanded_spans import commanded_spans
from quadlab.planners.kinematic_sqp.strides import cycle_chain
from quadlab.planners.kinematic_sqp.switches import beside_samples
from quadlab.planners.problem import Waypoints


def grid(motion: Motion) -> SampleGrid:
    asked = problem("anymal_b", motion)
    return sample_grid(cycle_chain(asked, 16, 8), asked.start.yaw)


def test_paper_problem_has_two_cycles_of_16_samples_and_one_extra() -> None:
    samples = grid(PAPER_MOTIONS["trot"])
    assert samples.samples == 33
    assert [span.cycle.periodic for span in samples.spans] == [False, True]
    assert not samples.ends_at_rest
    assert samples.wraps == (samples.spans[1],)


@pytest.mark.parametrize(
    ("motion", "expected"),
    [
        ("walk", [(False, 1), (False, 1), (True, 2), (False, 1), (False, 1)]),
        ("trot", [(False, 1), (False, 1), (True, 4), (False, 1), (False, 1)]),
        ("transition", [(False, 1), (False, 1), (True, 3), (False, 1), (False, 1)]),
    ],
)
def test_only_the_middle_of_equal_strides_repeats(motion: str, expected: list[tuple[bool, int]]) -> None:
    """Standing, first stride, repeated stride, last stride, standing; a walk before is the first stride of a trot."""
    samples = grid(WHOLE_MOTIONS[motion])
    assert [(span.cycle.periodic, span.cycle.repeats) for span in samples.spans] == expected
    assert samples.ends_at_rest


def test_total_time_is_that_of_the_schedule() -> None:
    for motion in (WHOLE_MOTIONS["walk"], WHOLE_MOTIONS["trot"]):
        samples = grid(motion)
        total = sum(span.cycle.duration_s * span.cycle.repeats for span in samples.spans)
        assert total == pytest.approx(sum(motion.strides_s) + 2.0 * motion.rest_s)


@pytest.mark.parametrize("motion", WHOLE_MOTIONS)
def test_who_carries_stands_on_both_sides_of_the_sample(motion: str) -> None:
    samples = grid(WHOLE_MOTIONS[motion])
    inner = samples.support[1:-1]
    assert not (inner & ~samples.contacts[:-1]).any()
    assert not (inner & ~samples.contacts[1:]).any()
    assert samples.support.any(axis=1).all()


def test_feet_are_up_only_within_swings() -> None:
    samples = grid(PAPER_MOTIONS["walk"])
    heights = samples.foot_heights(0.1)
    assert heights.max() == pytest.approx(0.1, rel=0.25)
    touching = np.vstack([samples.contacts[:1], samples.contacts]) | np.vstack([samples.contacts, samples.contacts[:1]])
    np.testing.assert_array_equal(heights[touching], 0.0)
    assert (heights[~touching] > 0.0).all()


def test_long_rests_have_few_samples_and_a_pause() -> None:
    """Short sample periods beside the steps, one long interval, and standing still after the last sample."""
    motion = replace(WHOLE_MOTIONS["trot"], rest_s=5.0)
    samples = grid(motion)
    first, last = samples.spans[0].cycle, samples.spans[-1].cycle
    assert first.duration_s == pytest.approx(5.0)
    assert len(first.periods_s) == 8
    np.testing.assert_allclose(np.delete(first.periods_s, 1), 0.05)
    np.testing.assert_allclose(last.periods_s, 0.05)


def test_standing_alone_is_one_rest() -> None:
    asked = problem("anymal_b", WHOLE_MOTIONS["trot"])
    schedule = ContactSchedule(np.array([2.0]), np.ones((1, 4), dtype=bool))
    pose = asked.waypoints.poses[0]
    standing = replace(asked, schedule=schedule, waypoints=Waypoints(np.array([0.0, 2.0]), np.array([pose, pose])))
    samples = sample_grid(cycle_chain(standing, 16, 8), 0.0)
    assert len(samples.spans) == 1
    assert samples.ends_at_rest
    assert not samples.wraps


def beside(motion: Motion, samples_per_cycle: int) -> str:
    asked = problem("anymal_b", motion)
    samples = sample_grid(cycle_chain(asked, samples_per_cycle, 8), asked.start.yaw)
    return beside_samples(asked.schedule, asked.waypoints, samples.unrolled_times_s, samples_per_cycle)


@pytest.mark.parametrize("motion", WHOLE_MOTIONS)
def test_switches_of_the_paper_lie_on_samples(motion: str) -> None:
    assert beside(WHOLE_MOTIONS[motion], 16) == ""


def test_switches_between_samples_are_told_with_how_many_samples_would_meet_them() -> None:
    pace = Motion(("pace",) * 4, (0.8,) * 4, (0.1, 0.0, 0.0), 0.4)
    assert beside(pace, 16) == (
        "contact switches lie up to 20 ms beside samples; planner.samples_per_cycle=20 would meet them"
    )
    assert beside(pace, 20) == ""


@pytest.mark.parametrize("offset", [np.zeros(3), np.array([-0.02, 0.04, 0.1])], ids=["on the path", "beside the path"])
@pytest.mark.parametrize("motion", WHOLE_MOTIONS)
def test_what_is_commanded_leads_from_the_start_to_the_goal(motion: str, offset: Array) -> None:
    """Rests included: what is left of the first stance leads a robot beside its path back to it."""
    asked = beside_path(problem("anymal_b", WHOLE_MOTIONS[motion]), offset)
    samples = sample_grid(cycle_chain(asked, 16, 8), asked.start.yaw)
    repeats = [span.cycle.repeats for span in samples.spans if span.cycle.moves]
    pose = asked.waypoints.poses[0]
    for span, runs in zip(commanded_spans(samples), repeats, strict=True):
        for _ in range(runs):
            pose = compose(pose, span.increment)
    np.testing.assert_allclose(pose, asked.waypoints.poses[-1], atol=1e-12)
