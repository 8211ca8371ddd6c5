"""Verdicts on solvers: counted as they are, failures as rows."""

import pandas as pd
import pytest

from quadlab.analysis.solver_certificate import count_verdicts, judge_trial, report
from quadlab.controllers.solver_opinions import LEXICOGRAPHIC, METHODS, Opinion


def test_failed_uncertified_and_wrong_are_told_apart() -> None:
    answers = [
        Opinion("m", solved=True, remainder=1e-9, differs=False, time_us=1.0),
        Opinion("m", solved=True, remainder=1e-5, differs=False, time_us=1.0),
        Opinion("m", solved=True, remainder=1e-5, differs=True, time_us=1.0),
        Opinion("m", solved=False, remainder=1.0, differs=True, time_us=1.0),
    ]
    counts = count_verdicts("m", pd.DataFrame([vars(answer) for answer in answers]))
    assert [counts[name] for name in ("states", "failed", "uncertified", "wrong")] == [4, 1, 2, 1]
    assert counts["remainder_max"] == pytest.approx(1e-5)


def test_hierarchies_of_a_closed_loop_are_certified() -> None:
    rows = judge_trial("trot", ("controller=bellicoso2016", "gait=trot", "duration_s=3"), 200, 2)
    table = pd.DataFrame(rows)
    assert list(table["method"]) == list(METHODS)
    ours = table[table["method"] == LEXICOGRAPHIC].iloc[0]
    assert ours["states"] == 6
    assert ours["failed"] == ours["uncertified"] == ours["wrong"] == 0
    assert ours["change_by_lower_max"] < 1e-9
    assert "| trot | completed | 6 | 0 + 0 |" in report(table, "trials")
