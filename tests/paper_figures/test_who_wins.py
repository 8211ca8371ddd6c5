"""Conditions of the comparison, not trials, are what intervals are made of."""

import pandas as pd

from paper_figures.comparison.who_wins import averaged

TABLE = pd.DataFrame(
    {
        "planner": ["kinematic_sqp", "kinematic_sqp", "vertex_zmp", "vertex_zmp"] * 2,
        "controller": ["weighted", "hierarchical"] * 4,
        "seed": [0] * 4 + [1] * 4,
        "direction": [None] * 8,
        "error": [1.0, 3.0, 5.0, 7.0, 2.0, 2.0, 4.0, None],
    }
)


def test_trials_that_differ_in_the_other_factor_alone_count_once() -> None:
    means, condition = averaged(TABLE, "planner", "error")
    first = means[means["seed"] == "0"].set_index("planner")["error"]
    assert first.to_dict() == {"kinematic_sqp": 2.0, "vertex_zmp": 6.0}
    assert condition == ["direction", "seed"]


def test_condition_in_which_a_value_is_missing_is_left_out() -> None:
    means, _ = averaged(TABLE, "planner", "error")
    assert means[means["seed"] == "1"]["planner"].to_list() == ["kinematic_sqp"]
