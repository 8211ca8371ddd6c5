"""Plans survive the way to disk, and foreign files are refused in one line."""

from pathlib import Path

import numpy as np
import pytest
from planning_cases import solved

from quadlab.errors import LogError
from quadlab.planners.plan import MotionPlan
from quadlab.planners.plan_io import bytes_to_plan, load_plan, plan_to_bytes, save_plan


def good_plan() -> MotionPlan:
    motion = solved("anymal", "trot", "turn").plan
    assert motion is not None
    return motion


def test_round_trip_is_exact(tmp_path: Path) -> None:
    motion = good_plan()
    save_plan(motion, tmp_path / "some.plan")
    again = load_plan(tmp_path / "some.plan")
    for name in ("com", "heading", "cop"):
        np.testing.assert_array_equal(getattr(again, name).knots, getattr(motion, name).knots)
        np.testing.assert_array_equal(getattr(again, name).coefficients, getattr(motion, name).coefficients)
    np.testing.assert_array_equal(again.schedule.durations_s, motion.schedule.durations_s)
    np.testing.assert_array_equal(again.schedule.contacts, motion.schedule.contacts)
    for one, other in zip(again.footholds, motion.footholds, strict=True):
        np.testing.assert_array_equal(one, other)
    assert again.report == motion.report
    assert again.verdict == motion.verdict
    assert plan_to_bytes(again) == plan_to_bytes(motion)


@pytest.mark.parametrize("cut", [0, 10, 500, -1])
def test_cut_file_is_a_clear_error(cut: int) -> None:
    with pytest.raises(LogError, match="not a whole quadlab motion plan"):
        bytes_to_plan(plan_to_bytes(good_plan())[:cut])


def test_foreign_files_are_a_clear_error(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("hello")
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    np.save(tmp_path / "array.npy", np.zeros(3))
    for name in ("notes.txt", "other.npz", "array.npy", "missing.plan"):
        with pytest.raises(LogError, match=name):
            load_plan(tmp_path / name)


def test_other_version_is_a_clear_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("quadlab.planners.plan_io.VERSION", 99)
    data = plan_to_bytes(good_plan())
    monkeypatch.undo()
    with pytest.raises(LogError, match="version 99, expected 1"):
        bytes_to_plan(data)
