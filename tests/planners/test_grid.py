"""The time grid and the blocks of the nonlinear program."""

import numpy as np
import pytest
from planning_cases import COMMANDS, problem

from quadlab.gaits.schedule import ContactSchedule
from quadlab.planners.vertex_zmp.footholds import FootholdIndex
from quadlab.planners.vertex_zmp.grid import time_grid
from quadlab.planners.vertex_zmp.paper.costs.robustness import simpson_weights
from quadlab.planners.vertex_zmp.paper.layout import BlockLayout


def schedule_of(gait_name: str) -> ContactSchedule:
    return problem("anymal", gait_name, COMMANDS["forward"]).schedule


@pytest.mark.parametrize("gait_name", ["trot", "walk", "stand"])
@pytest.mark.parametrize("longest_s", [0.04, 0.1, 10.0])
def test_polynomials_tile_the_schedule_and_no_phase_switch_is_inside_one(gait_name: str, longest_s: float) -> None:
    schedule = schedule_of(gait_name)
    grid = time_grid(schedule, longest_s, 3)
    np.testing.assert_allclose(np.diff(grid.knots_s), grid.durations_s, atol=1e-12)
    assert grid.knots_s[-1] == pytest.approx(schedule.duration_s)
    assert grid.durations_s.max() <= longest_s + 1e-9
    for switch in schedule.switch_times_s:
        assert np.abs(grid.knots_s - switch).min() < 1e-9
    assert simpson_weights(grid).sum() == pytest.approx(schedule.duration_s)


def test_load_nodes_are_shared_within_a_phase_and_doubled_at_switches() -> None:
    grid = time_grid(ContactSchedule(np.array([0.2, 0.1]), np.ones((2, 4), dtype=bool)), 0.1, 3)
    np.testing.assert_array_equal(grid.nodes, [[0, 1, 2], [2, 3, 4], [5, 6, 7]])
    np.testing.assert_array_equal(grid.node_phases, [0] * 5 + [1] * 3)


def test_feet_move_from_one_foothold_to_the_next() -> None:
    footholds = FootholdIndex(schedule_of("trot"))
    swing = footholds.schedule.swings[0][0]
    times = np.array([0.0, swing.start_s, 0.5 * (swing.start_s + swing.end_s), swing.end_s])
    stances, shares = footholds.position_shares(0, times)
    np.testing.assert_array_equal(stances, [0, 0, 0, 1])
    np.testing.assert_allclose(shares, [0.0, 0.0, 0.5, 0.0], atol=1e-12)


def test_layout_packs_what_it_unpacks() -> None:
    layout = BlockLayout({"a": (2, 3), "b": (1, 1), "c": (4, 0)})
    values = {"a": np.arange(6.0).reshape(2, 3), "b": np.array([[9.0]]), "c": np.zeros((4, 0))}
    vector = layout.pack(values)
    assert len(vector) == layout.size == 7
    for name, value in values.items():
        np.testing.assert_array_equal(layout.value(name, vector), value)
    with pytest.raises(KeyError, match="blocks are a, b, c"):
        layout.block("d")
