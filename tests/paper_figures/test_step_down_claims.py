"""A leg that swings up does not extend downwards, and what comes before a limit is no answer to it."""

import numpy as np
import pandas as pd
import pytest

from paper_figures.bellicoso2016.figure5_step_down import STUDY
from paper_figures.reproduction import FOLDER
from paper_figures.step_down_claims import EDGE_M, lowers_at_the_limit, stays_low, stretched, tilts_at_the_limit
from paper_figures.trial_claims import completed
from quadlab.analysis.artefact import Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.controllers.telemetry import LegMode
from quadlab.errors import LogError
from quadlab.robots.legs import LEGS
from quadlab.studies.config import load_study

TIMES = np.arange(0.0, 2.0, 0.02)
STEP_M, LIMIT_M = 0.14, 0.5
EDGE = "scenario.terrain.0.edge_x_m"
HIND_FEET_M = 0.363  # behind the base of a standing ANYmal B


def _trace(foot_m: float, knee_deg: float = 3.0, falls_s: float = 1.5) -> pd.DataFrame:
    """Return a trial in which LF searches from 0.5 s on, its foot first below and then at ``foot_m``."""
    trace = pd.DataFrame(index=TIMES)
    for leg in LEGS:
        trace[f"control.leg_mode_{leg}"] = float(LegMode.STANCE)
        trace[f"control.foot_position_{leg}_z"] = np.where((falls_s <= TIMES) & (leg != "LF"), 0.4, 0.0)
        trace[f"state.joint_position_{leg}_KFE"] = -np.radians(knee_deg)
    trace.loc[0.5:, "control.leg_mode_LF"] = float(LegMode.SEARCH)
    trace.loc[0.5:1.0, "control.foot_position_LF_z"] = -0.07
    trace.loc[1.0:, "control.foot_position_LF_z"] = foot_m
    trace.loc[falls_s:, "control.foot_position_LF_z"] = 0.9
    return trace


@pytest.mark.parametrize(
    ("trace", "found"),
    [
        (_trace(foot_m=-0.07), Verdict.REPRODUCED),
        (_trace(foot_m=0.3), Verdict.PARTLY),
        (_trace(foot_m=-0.07, knee_deg=40.0), Verdict.NOT),
        (_trace(foot_m=-0.14), Verdict.NOT),
    ],
    ids=["straight and low", "swings up", "bent", "reaches the ground"],
)
def test_the_leg_extends_downwards_only_if_its_foot_stays_low(trace: pd.DataFrame, found: Verdict) -> None:
    claim = stretched(trace, STEP_M)
    assert claim.verdict is found
    assert bool(claim.why) is not stays_low(trace)


def test_heights_during_the_fall_do_not_count() -> None:
    assert stays_low(_trace(foot_m=-0.07))
    assert "900 mm" not in stretched(_trace(foot_m=0.3), STEP_M).ours


def _torso(tilt_s: float = 1.1, lower_s: float = 1.3) -> pd.DataFrame:
    """Return a trial whose LF and RH reach their limits at 1.0 and 1.2 s."""
    reached = {"LF": 1.0, "RH": 1.2}
    return pd.DataFrame(
        {
            "time_s": TIMES,
            "base_z_m": np.where(lower_s <= TIMES, 0.45, 0.5),
            "pitch_deg": np.where(tilt_s <= TIMES, 5.0, 0.0),
            "roll_deg": 0.0,
            **{f"{leg}_extension_m": np.where(reached.get(leg, np.inf) <= TIMES, 0.51, 0.45) for leg in LEGS},
        }
    )


@pytest.mark.parametrize(("tilt_s", "found"), [(1.1, Verdict.REPRODUCED), (0.8, Verdict.NOT), (1.8, Verdict.NOT)])
def test_a_torso_answers_a_limit_after_it_and_soon(tilt_s: float, found: Verdict) -> None:
    assert tilts_at_the_limit(_torso(tilt_s=tilt_s), LIMIT_M).verdict is found


@pytest.mark.parametrize(("lower_s", "found"), [(1.3, Verdict.REPRODUCED), (1.1, Verdict.PARTLY), (9.0, Verdict.NOT)])
def test_the_torso_goes_down_after_the_diagonal_hind_leg_is_at_its_limit(lower_s: float, found: Verdict) -> None:
    assert lowers_at_the_limit(_torso(lower_s=lower_s), LIMIT_M).verdict is found


def test_whoever_completes_the_walk_has_its_hind_feet_down_as_well() -> None:
    try:
        rows = completed(StudyResults(FOLDER.parent / "results").table(STUDY))
    except LogError as error:
        pytest.skip(str(error))
    assert (rows["distance_m"] - rows[EDGE]).min() > HIND_FEET_M


def test_kept_curves_are_of_the_edge_that_the_claims_name() -> None:
    assert {trace.where[EDGE] for trace in load_study(STUDY).traces} == {EDGE_M}
