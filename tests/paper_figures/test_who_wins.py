"""Conditions of the comparison, not trials, are what intervals are made of."""

import pandas as pd
import pytest

from paper_figures.comparison.who_wins import MEASURES, Measure, asked, averaged, better_of, row_of
from paper_figures.comparison_variants import Question
from quadlab.errors import LogError

KINEMATIC_OR_VERTEX = Question("planner", "kinematic_sqp", "vertex_zmp", "controller", ("weighted", "hierarchical"))
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
    means, condition = averaged(TABLE, KINEMATIC_OR_VERTEX, "error")
    first = means[means["seed"] == "0"].set_index("planner")["error"]
    assert first.to_dict() == {"kinematic_sqp": 2.0, "vertex_zmp": 6.0}
    assert condition == ["direction", "seed"]


def test_condition_in_which_a_value_is_missing_is_left_out() -> None:
    means, _ = averaged(TABLE, KINEMATIC_OR_VERTEX, "error")
    assert means[means["seed"] == "1"]["planner"].to_list() == ["kinematic_sqp"]


@pytest.mark.parametrize(
    ("percent", "corrected", "larger_is_better", "better"),
    [
        (5.0, 0.01, True, "hierarchical"),
        (5.0, 0.01, False, "weighted"),
        (-5.0, 0.01, False, "hierarchical"),
        (1.0, 0.001, False, None),  # sure, and too small to matter
        (50.0, 0.06, False, None),  # large, and not sure
    ],
)
def test_better_is_what_is_sure_and_large_enough(
    percent: float, corrected: float, larger_is_better: bool, better: str | None
) -> None:
    row = pd.Series(
        {
            "first": "weighted",
            "second": "hierarchical",
            "difference_percent": percent,
            "corrected": corrected,
            "larger_is_better": larger_is_better,
        }
    )
    assert better_of(row) == better


def test_difference_that_one_kind_of_condition_makes_alone_says_so() -> None:
    completed = MEASURES[0]
    question = KINEMATIC_OR_VERTEX
    levels = [(planner, controller) for planner in (question.first, question.second) for controller in question.over]
    trials = pd.DataFrame(
        [
            (disturbance, "walk", seed, planner, controller, float(disturbance == "none" or planner == "vertex_zmp"))
            for disturbance in ("none", "low friction")
            for seed in range(3)
            for planner, controller in levels
        ],
        columns=["disturbance", "gait", "seed", "planner", "controller", completed.column],
    )
    row = row_of(question, completed.name, completed, trials)
    assert row["only_in"] == "low friction, walk"
    assert row["differing"] == 3
    assert row["pairs"] == 6
    assert row["probability"] == pytest.approx(0.25)


def test_gait_that_one_of_the_two_cannot_do_is_no_condition() -> None:
    trials = pd.DataFrame(
        [
            ("none", "walk", "zmp_spline", "weighted"),
            ("none", "walk", "vertex_zmp", "weighted"),
            ("none", "walk", "kinematic_sqp", "weighted"),
            ("none", "trot", "vertex_zmp", "weighted"),
            ("slope up", "walk", "vertex_zmp", "weighted"),
            ("none", "walk", "vertex_zmp", "another"),
        ],
        columns=["disturbance", "gait", "planner", "controller"],
    )
    question = Question("planner", "zmp_spline", "vertex_zmp", "controller", ("weighted",))
    assert asked(trials, question).index.to_list() == [0, 1]


def test_question_without_a_pair_says_what_is_missing() -> None:
    error = Measure("error", "error", False)
    with pytest.raises(LogError, match="no pair to tell 'error' of vertex_zmp minus kinematic_sqp"):
        row_of(
            KINEMATIC_OR_VERTEX, error.name, error, TABLE[TABLE["controller"] == "weighted"].assign(disturbance="none")
        )
