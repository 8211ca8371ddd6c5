"""A view from above shows the whole plan, undistorted, where it belongs."""

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from plotting_cases import GAITS, gait_schedule, straight_plan

from quadlab.geometry.rotations import Array, rotation_2d
from quadlab.planners.plan import MotionPlan
from quadlab.plotting.axes.plan_view import draw_placed_plan, frame_points, plan_points
from quadlab.plotting.placed_plan import in_plan_frame, place_plan
from quadlab.plotting.plan_figure import plan_figure
from quadlab.plotting.style import LEG_COLOURS


@pytest.fixture(params=GAITS)
def plan(request: pytest.FixtureRequest) -> MotionPlan:
    return straight_plan(gait_schedule(request.param))


def test_axes_contain_every_foothold_and_are_equal(plan: MotionPlan) -> None:
    axes = plan_figure(plan).axes[0]
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    for footholds in plan.footholds:
        x, y, _ = footholds.T
        assert left < x.min()
        assert x.max() < right
        assert bottom < y.min()
        assert y.max() < top
    assert axes.get_aspect() == 1.0


def test_footholds_are_drawn_at_their_places_in_the_colours_of_their_legs(plan: MotionPlan) -> None:
    axes = Figure().subplots()
    draw_placed_plan(axes, in_plan_frame(plan))
    for footholds, colour in zip(plan.footholds, LEG_COLOURS, strict=True):
        marks = [line for line in axes.lines if line.get_marker() in ("s", "o") and to_hex(line.get_color()) == colour]
        assert [line.get_marker() for line in marks] == ["s", "o"]
        drawn = np.concatenate([line.get_xydata() for line in marks])
        np.testing.assert_allclose(drawn, footholds[:, :2])


def test_the_cop_lies_over_the_com_and_below_the_footholds(plan: MotionPlan) -> None:
    axes = Figure().subplots()
    draw_placed_plan(axes, in_plan_frame(plan))
    (cop,) = [line for line in axes.lines if line.get_marker() == "."]
    (com,) = axes.collections
    feet = [line.get_zorder() for line in axes.lines if line.get_marker() in ("s", "o")]
    assert com.get_zorder() < cop.get_zorder() < min(feet)


def test_every_support_area_is_made_of_the_feet_that_stand(plan: MotionPlan) -> None:
    placed = in_plan_frame(plan)
    assert len(placed.supports) == len(plan.schedule.durations_s)
    for support, contacts in zip(placed.supports, plan.schedule.contacts, strict=True):
        assert len(support.corners) <= contacts.sum()
        for corner in support.corners:
            nearest = min(np.linalg.norm(foot[:, :2] - corner, axis=1).min() for foot in plan.footholds)
            assert nearest < 1e-12


def test_a_displaced_plan_is_the_same_plan_moved(plan: MotionPlan) -> None:
    pose = np.array([1.0, -2.0, 0.7])
    here, there = in_plan_frame(plan), place_plan(plan, lambda _: pose, plan.duration_s)
    for before, after in zip(plan_points(here), plan_points(there), strict=True):
        np.testing.assert_allclose(after, pose[:2] + before @ rotation_2d(0.7).T, atol=1e-12)


def test_a_foothold_lies_where_the_plan_lay_while_its_foot_stood(plan: MotionPlan) -> None:
    swing = plan.schedule.swings[0][0]

    def jumps_in_swing(time_s: float) -> Array:
        return np.array([0.0, 0.3 if time_s > swing.start_s + 0.5 * swing.duration_s else 0.0, 0.0])

    placed = place_plan(plan, jumps_in_swing, plan.duration_s)
    offsets = placed.footholds[0][:, 1] - plan.footholds[0][:, 1]
    np.testing.assert_allclose(offsets, [0.0, *[0.3] * (len(offsets) - 1)])


def test_a_trial_that_ended_early_shows_no_later_foothold(plan: MotionPlan) -> None:
    swing = plan.schedule.swings[1][0]
    placed = place_plan(plan, lambda _: np.zeros(3), swing.start_s)
    assert len(placed.footholds[1]) == 1
    assert placed.times_s[-1] == swing.start_s


def test_a_robot_that_stays_in_place_still_gets_an_area() -> None:
    axes = Figure().subplots()
    frame_points(axes, [np.zeros((5, 2)), np.empty((0, 2))])
    assert axes.get_xlim()[0] < 0.0 < axes.get_xlim()[1]
    assert axes.get_ylim()[0] < 0.0 < axes.get_ylim()[1]
