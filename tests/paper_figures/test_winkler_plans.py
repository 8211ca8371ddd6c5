"""Plans are judged by where their CoM goes, how it sways and where the CoP is, not by what the planner enforces."""

import numpy as np
import pytest

from paper_figures.winkler2017.figure5_plans import forward_claim, near_claim, sway_claim, turning_points
from paper_figures.winkler2017.robustness_cost import sway_claim as width_claim
from quadlab.analysis.artefact import Verdict
from quadlab.geometry.rotations import Array
from quadlab.plotting.placed_plan import PlacedPlan

TIMES = np.linspace(0.0, 1.0, 101)


def _placed(com_x: Array, cop_x: Array | None = None) -> PlacedPlan:
    com, cop = (np.column_stack([x, np.zeros(len(TIMES))]) for x in (com_x, com_x if cop_x is None else cop_x))
    return PlacedPlan(TIMES, np.ones((len(TIMES), 4), bool), com, cop, (), ())


@pytest.mark.parametrize(("back_m", "found"), [(0.0, Verdict.REPRODUCED), (0.2, Verdict.NOT)])
def test_a_walk_that_first_goes_back_is_not_that_of_the_paper(back_m: float, found: Verdict) -> None:
    claim = forward_claim("walk", _placed(TIMES - back_m * np.sin(np.pi * np.minimum(4.0 * TIMES, 1.0))), "why")
    assert claim.verdict is found
    assert claim.why == ("" if found is Verdict.REPRODUCED else "why")


def test_small_ripples_are_no_turning_points() -> None:
    waves = np.cos(8.0 * np.pi * TIMES)
    assert turning_points(TIMES, 0.1) == 0
    assert turning_points(TIMES + 0.01 * waves, 0.1) == 0
    assert turning_points(waves + 0.01 * np.cos(60.0 * np.pi * TIMES), 0.1) == 7


@pytest.mark.parametrize(("waves", "found"), [(0, Verdict.NOT), (1, Verdict.PARTLY), (4, Verdict.REPRODUCED)])
def test_swaying_means_once_a_stride(waves: int, found: Verdict) -> None:
    assert sway_claim("sways", 0.1 * np.cos(2.0 * np.pi * waves * TIMES)).verdict is found


@pytest.mark.parametrize(("ends", "found"), [(0.1, Verdict.REPRODUCED), (0.02, Verdict.NOT)])
def test_cop_of_a_trot_is_far_from_the_com_at_both_ends(ends: float, found: Verdict) -> None:
    offset = np.where(abs(TIMES - 0.5) > 0.25, ends, 0.02)
    assert near_claim(_placed(TIMES, TIMES + offset)).verdict is found


@pytest.mark.parametrize(
    ("none_mm", "found"), [(2.0, Verdict.REPRODUCED), (30.0, Verdict.PARTLY), (200.0, Verdict.NOT)]
)
def test_another_cost_does_not_make_the_com_straight_for_the_paper(none_mm: float, found: Verdict) -> None:
    assert width_claim({"robustness": 160.0, "acceleration": 0.0, "none": none_mm}).verdict is found
