"""Gaits become contact schedules."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from pydantic import ValidationError

from quadlab.errors import ConfigurationError
from quadlab.gaits.gait import CycleConfig, GaitConfig, contact_schedule, stride_counts, stride_times
from quadlab.robots.legs import LEGS, leg_index

CONF = Path(__file__).parents[2] / "conf" / "gait"
DIAGONAL = {"LF": "RH", "RF": "LH"}
TROT_PATTERN = {"LF": "#.##", "RF": "###.", "LH": "###.", "RH": "#.##"}


def gait(name: str) -> GaitConfig:
    return GaitConfig(**yaml.safe_load((CONF / f"{name}.yaml").read_text()))


def cycle(pattern: dict[str, str] | None = None, **changes: Any) -> CycleConfig:
    return CycleConfig(**{"stride_duration_s": 0.8, "pattern": pattern or TROT_PATTERN, **changes})


def two_gaits() -> GaitConfig:
    walking = {leg: "#" * i + "." + "#" * (3 - i) for i, leg in enumerate(LEGS)}
    slow = cycle(walking, stride_duration_s=4.0, strides=1)
    return GaitConfig(name="change", initial_stance_s=0.5, final_stance_s=0.5, cycles=(slow, cycle()))


@pytest.mark.parametrize("path", sorted(CONF.glob("*.yaml")), ids=lambda path: path.stem)
@pytest.mark.parametrize("duration_s", [12.0, 17.3, 30.0])
def test_schedule_of_every_gait_file_fills_the_trial(path: Path, duration_s: float) -> None:
    schedule = contact_schedule(gait(path.stem), duration_s)
    assert schedule.duration_s == pytest.approx(duration_s)
    assert (schedule.durations_s > 0.0).all()
    assert schedule.contacts.any(axis=1).all()
    assert (schedule.contacts[1:] != schedule.contacts[:-1]).any(axis=1).all()


LAME = {"three_legs": [leg_index("LF")]}  # carried from the first stride to the last


@pytest.mark.parametrize("path", sorted(CONF.glob("*.yaml")), ids=lambda path: path.stem)
def test_gait_ends_standing_and_every_leg_swings_equally_often(path: Path) -> None:
    schedule = contact_schedule(gait(path.stem), 20.0)
    assert schedule.contacts[0].all()
    assert schedule.contacts[-1].all()
    lame = LAME.get(path.stem, [])
    assert len({len(swings) for leg, swings in enumerate(schedule.swings) if leg not in lame}) == 1
    assert all(len(schedule.swings[leg]) == 1 for leg in lame)


def test_trot_swings_diagonal_legs_together_and_alternates() -> None:
    schedule = contact_schedule(gait("trot"), 6.0)
    for leg, other in DIAGONAL.items():
        assert schedule.swings[leg_index(leg)] == schedule.swings[leg_index(other)]
    for one, other_swing in zip(schedule.swings[0], schedule.swings[1], strict=True):
        assert one.duration_s == pytest.approx(0.35)
        assert other_swing.start_s - one.start_s == pytest.approx(0.4)
    assert schedule.contacts.sum(axis=1).min() == 2


def test_walk_lifts_one_leg_at_a_time_in_lateral_sequence() -> None:
    schedule = contact_schedule(gait("walk"), 12.0)
    assert schedule.contacts.sum(axis=1).min() == 3
    lifted = sorted((swing.start_s, leg) for leg, swings in enumerate(schedule.swings) for swing in swings)
    assert [LEGS[leg] for _, leg in lifted] == ["LH", "LF", "RH", "RF"] * 2


def test_swing_that_crosses_the_stride_boundary_is_one_swing() -> None:
    pattern = {"LF": ".##.", "RF": "####", "LH": "####", "RH": "####"}
    config = GaitConfig(name="wrap", initial_stance_s=0.2, final_stance_s=0.2, cycles=(cycle(pattern, strides=2),))
    swings = contact_schedule(config, 2.0).swings[0]
    assert [swing.duration_s for swing in swings] == pytest.approx([0.2, 0.4, 0.2])


def test_standing_is_a_single_phase() -> None:
    schedule = contact_schedule(gait("stand"), 3.7)
    np.testing.assert_allclose(schedule.durations_s, [3.7])
    assert schedule.contacts.all()


def test_cycles_follow_each_other() -> None:
    config = two_gaits()
    assert stride_counts(config, 8.0) == [1, 3]
    np.testing.assert_allclose(stride_times(config, 8.0), [0.5, 4.5, 5.3, 6.1, 6.9])
    schedule = contact_schedule(config, 8.0)
    assert schedule.duration_s == pytest.approx(8.0)
    assert [len(swings) for swings in schedule.swings] == [4, 4, 4, 4]


def test_stride_that_exactly_fits_counts() -> None:
    config = GaitConfig(name="trot", initial_stance_s=0.6, final_stance_s=0.6, cycles=(cycle(),))
    assert stride_counts(config, 0.6 + 3 * 0.8 + 0.6) == [3]


def test_trial_too_short_for_a_fixed_number_of_strides_is_a_clear_error() -> None:
    config = GaitConfig(name="trot", initial_stance_s=0.6, final_stance_s=0.6, cycles=(cycle(strides=4),))
    assert stride_counts(config, 4.4) == [4]
    with pytest.raises(ConfigurationError, match=r"4 s is too short for gait 'trot'; its 4 strides need 4\.4 s"):
        stride_counts(config, 4.0)


def test_too_short_a_trial_is_a_clear_error() -> None:
    with pytest.raises(ConfigurationError, match="duration_s: 1 s is too short for gait 'trot'; one stride needs 2 s"):
        contact_schedule(gait("trot"), 1.0)


@pytest.mark.parametrize(
    ("pattern", "message"),
    [
        ({"LF": "#"}, "one row for each of LF, RF, LH, RH"),
        (dict.fromkeys(("LF", "RF", "LH", "XX"), "#"), "one row for each of LF, RF, LH, RH"),
        ({**dict.fromkeys(LEGS, "##"), "LF": "#"}, "same number of columns"),
        (dict.fromkeys(LEGS, ""), "same number of columns"),
        (dict.fromkeys(LEGS, "#x"), "rows hold only"),
    ],
)
def test_malformed_patterns_are_refused(pattern: dict[str, str], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        CycleConfig(stride_duration_s=1.0, pattern=pattern)


@pytest.mark.parametrize("changes", [{"stride_duration_s": 0.0}, {"strides": 0}, {"unknown": 1}])
def test_malformed_cycles_are_refused(changes: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        cycle(**changes)


def test_only_the_last_cycle_may_be_open() -> None:
    with pytest.raises(ValidationError, match="only the last cycle"):
        GaitConfig(name="open", initial_stance_s=0.0, final_stance_s=0.0, cycles=(cycle(), cycle()))
