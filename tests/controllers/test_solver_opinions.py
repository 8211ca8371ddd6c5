"""Several methods on one hierarchy: they agree where it is easy, and a wrong answer is called wrong."""

import numpy as np
import pytest

from quadlab.controllers import solver_opinions
from quadlab.controllers.hierarchy import Level
from quadlab.controllers.solver_opinions import LEXICOGRAPHIC, METHODS, QUICK, change_by_lower_levels, opinions
from quadlab.geometry.rotations import Array

START = np.zeros(3)


def levels() -> list[Level]:
    """A box, a target outside of it, an empty level, and a wish for what is left."""
    wish = np.array([-5.0, 9.0, 7.0])
    return [
        Level("box", np.eye(3), np.full(3, -1.0), np.ones(3)),
        Level("target", np.array([[1.0, 0.5, 0.0]]), np.array([4.0]), np.array([4.0])),
        Level("empty", np.zeros((0, 3)), np.zeros(0), np.zeros(0)),
        Level("wish", np.eye(3), wish, wish),
    ]


def test_active_set_methods_agree_in_a_corner() -> None:
    """In the corner of the box the frozen set has no interior, where back ends of the cascade may fail."""
    found = {opinion.method: opinion for opinion in opinions(levels(), START)}
    assert list(found) == list(METHODS)
    for method in (*QUICK, "cascade, daqp"):
        assert found[method].solved
        assert not found[method].differs
    assert found[LEXICOGRAPHIC].remainder < 1e-12


def test_a_wrong_answer_of_a_method_that_claims_success_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def liar(levels: list[Level]) -> tuple[Array, bool]:
        return np.array([0.9, 1.0, 1.0]), True

    monkeypatch.setattr(solver_opinions, "solve_daqp_hierarchical", liar)
    (opinion,) = opinions(levels(), START, (solver_opinions.DAQP,))
    assert opinion.solved
    assert opinion.remainder > 1e-3
    assert opinion.differs


def test_an_answer_without_numbers_is_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(solver_opinions, "solve_daqp_hierarchical", lambda levels: (np.full(3, np.nan), True))
    (opinion,) = opinions(levels(), START, (solver_opinions.DAQP,))
    assert not opinion.solved
    assert opinion.remainder == np.inf


def test_lower_levels_leave_the_slacks_of_higher_ones_alone() -> None:
    assert change_by_lower_levels(levels(), START) < 1e-12
    assert opinions(levels(), START, (LEXICOGRAPHIC,))[0].remainder < 1e-12
