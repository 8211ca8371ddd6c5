"""A plan in space shows its feet and swings where they are."""

import numpy as np
import pytest
from plotting_cases import GAITS, gait_schedule, straight_plan

from quadlab.planners.plan import MotionPlan
from quadlab.plotting.plan_space_figure import plan_space_figure, swing_arcs


@pytest.fixture(params=GAITS)
def plan(request: pytest.FixtureRequest) -> MotionPlan:
    return straight_plan(gait_schedule(request.param))


def test_arcs_lead_from_foothold_to_foothold_over_the_ground(plan: MotionPlan) -> None:
    for leg, footholds in enumerate(plan.footholds):
        arcs = swing_arcs(plan, leg)
        assert len(arcs) == len(footholds) - 1
        for arc, start, end in zip(arcs, footholds[:-1], footholds[1:], strict=True):
            np.testing.assert_allclose(arc[[0, -1]], [start, end], atol=1e-9)
            assert (arc[1:-1, 2] > min(start[2], end[2])).all()


def test_arcs_are_as_high_as_asked_for(plan: MotionPlan) -> None:
    for arc in swing_arcs(plan, 0, 0.09):
        assert np.isclose(arc[:, 2].max() - arc[0, 2], 0.09)


def test_box_contains_com_and_footholds_undistorted(plan: MotionPlan) -> None:
    (axes,) = plan_space_figure(plan).axes
    limits = np.array([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()])  # type: ignore[attr-defined]
    com = np.array([plan.com(time) for time in np.linspace(0.0, plan.duration_s, 50)])
    points = np.concatenate([com, *plan.footholds])
    assert (points >= limits[:, 0] - 1e-9).all()
    assert (points <= limits[:, 1] + 1e-9).all()
    sides = np.asarray(axes._box_aspect)  # type: ignore[attr-defined]
    np.testing.assert_allclose(sides / sides[0], np.ptp(limits, axis=1) / np.ptp(limits[0]))
