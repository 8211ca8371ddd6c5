"""What people see of a sweep: a line for every trial, counts that add up, failures when they happen."""

import io
from pathlib import Path

import pytest

from quadlab.sweeps.count import SweepCount, duration_text
from quadlab.sweeps.terminal import LiveSweep, PlainSweep, terminal_sweep
from quadlab.trials.job import JobOutcome
from quadlab.trials.result import TrialResult, TrialStatus


def _job(status: TrialStatus, skipped: bool = False) -> JobOutcome:
    names = dict.fromkeys(("robot", "gait", "planner", "controller", "estimator", "scenario", "trial_id"), "x")
    result = TrialResult(status=status, status_reason="why", seed=0, duration_s=1.0, **names)
    return JobOutcome(Path("x"), result, skipped)


FAILED = JobOutcome(Path("x"), None, failure="killed by SIGKILL")


def test_plain_lines_name_every_outcome() -> None:
    stream = io.StringIO()
    progress = PlainSweep(stream)
    progress.begin(3, 2)
    for name, job in (("a", _job(TrialStatus.COMPLETED)), ("b", _job(TrialStatus.FELL)), ("c", FAILED)):
        progress.started(name)
        progress.ended(name, job)
    progress.end()
    lines = stream.getvalue().splitlines()
    assert lines[:4] == [
        "sweep: 3 trials, 2 at a time",
        "sweep: [1/3] a: completed, why",
        "sweep: [2/3] b: fell, why",
        "sweep: [3/3] c: killed by SIGKILL",
    ]
    assert lines[4].startswith("sweep: 3 of 3 done, 1 completed, 1 failure, 1 fell, ")


def test_live_table_leaves_a_line_for_what_did_not_complete_and_none_for_the_rest() -> None:
    stream = io.StringIO()
    progress = LiveSweep(stream)
    progress.begin(3, 2)
    for name, job in (("good", _job(TrialStatus.COMPLETED)), ("fallen", _job(TrialStatus.FELL)), ("dead", FAILED)):
        progress.started(name)
        progress.ended(name, job)
    progress.end()
    shown = stream.getvalue()
    assert "fallen: fell, why" in shown
    assert "dead: killed by SIGKILL" in shown
    assert "good: " not in shown
    assert "3 of 3 done" in shown


def test_time_left_counts_only_what_was_run() -> None:
    count = SweepCount(4, 2)
    count.end("before", _job(TrialStatus.COMPLETED, skipped=True))
    assert count.left_s is None
    count.start("now")
    count.end("now", _job(TrialStatus.COMPLETED))
    assert count.left_s is not None
    assert (count.done, count.skipped) == (2, 1)


@pytest.mark.parametrize(("seconds", "text"), [(0.4, "0:00"), (67.0, "1:07"), (7439.0, "2:03:59")])
def test_durations_read_like_a_clock(seconds: float, text: str) -> None:
    assert duration_text(seconds) == text


def test_pipes_get_plain_lines() -> None:
    assert isinstance(terminal_sweep(io.StringIO()), PlainSweep)
