"""What is read off the curves of a walk that is pushed: footprints, an unloaded foot, where the reference goes."""

import numpy as np
import pandas as pd
import pytest

from paper_figures.gehring2017.figure5_walk_push import footprints, reference_adapts, stands, unloading
from quadlab.analysis.artefact import Verdict
from quadlab.controllers.telemetry import LegMode

TIMES = np.arange(0, 300) / 100.0
PUSH_S = 1.0


def _trace(**columns: np.ndarray) -> pd.DataFrame:
    """Return curves of which LH stands, loaded, at 0; a push to the right begins at ``PUSH_S``."""
    still = {
        "control.leg_mode_LH": LegMode.STANCE,
        "control.planned_contact_LH": 1.0,
        "control.com_reference_y": 0.0,
        "state.foot_force_LH_z": 70.0,
        **{f"control.foot_position_LH_{axis}": 0.0 for axis in "xyz"},
    }
    pushed = np.where((TIMES >= PUSH_S) & (TIMES < PUSH_S + 0.15), -160.0, 0.0)
    return pd.DataFrame({**still, "state.push_force_y": pushed, **columns}, index=TIMES)


def _modes(first: int, last: int, mode: LegMode) -> np.ndarray:
    modes = np.full(len(TIMES), int(LegMode.STANCE))
    modes[first:last] = mode
    return modes


@pytest.mark.parametrize(("samples", "stances"), [(1, 1), (4, 1), (6, 2), (40, 2)])
def test_short_losses_of_contact_are_no_new_footprint(samples: int, stances: int) -> None:
    trace = _trace(**{"control.leg_mode_LH": _modes(100, 100 + samples, LegMode.SEARCH)})
    assert len(footprints(trace, "LH")) == stances
    assert stands(trace, "LH").all() == (stances == 1)


def test_footprints_are_means_of_stances() -> None:
    places = np.where(TIMES < 1.5, 0.1, 0.3)
    trace = _trace(**{"control.leg_mode_LH": _modes(120, 150, LegMode.SWING), "control.foot_position_LH_x": places})
    np.testing.assert_allclose(footprints(trace, "LH"), [[0.1, 0.0], [0.3, 0.0]])


def test_a_foot_is_unloaded_only_where_it_stands_by_plan_soon_after_the_push() -> None:
    force = np.where((TIMES < 0.5) | ((TIMES >= 1.2) & (TIMES < 1.5)) | (TIMES >= 2.5), 0.0, 70.0)
    planned = np.where((TIMES >= 1.4) & (TIMES < 1.5), 0.0, 1.0)
    height = np.where((TIMES >= 1.3) & (TIMES < 1.35), 0.006, 0.0)
    columns = {"state.foot_force_LH_z": force, "control.planned_contact_LH": planned}
    unloaded_s, lifted_m = unloading(_trace(**columns, **{"control.foot_position_LH_z": height}), PUSH_S)
    assert (round(unloaded_s, 3), lifted_m) == (0.2, 0.006)


@pytest.mark.parametrize(("moved_m", "verdict"), [(-0.06, Verdict.REPRODUCED), (0.06, Verdict.NOT), (0.0, Verdict.NOT)])
def test_the_reference_has_to_move_with_the_push(moved_m: float, verdict: Verdict) -> None:
    reference = np.where(TIMES > PUSH_S + 0.2, moved_m, 0.0)
    claim = reference_adapts(_trace(**{"control.com_reference_y": reference}), np.zeros(len(TIMES)))
    assert claim.verdict is verdict
