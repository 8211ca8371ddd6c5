"""Only conditions that both levels have are compared, each with its own partner."""

import numpy as np
import pandas as pd

from quadlab.analysis.paired import pairs

TABLE = pd.DataFrame(
    {
        "controller": ["weighted", "strict", "weighted", "strict", "weighted"],
        "seed": [0, 0, 1, 1, 2],
        "error": [2.0, 1.0, 4.0, 2.0, 100.0],
    }
)
LEVELS = ("weighted", "strict")


def test_pairs_agree_in_everything_else() -> None:
    found = pairs(TABLE, "controller", LEVELS, ["seed"], "error")
    assert list(found["weighted"]) == [2.0, 4.0]
    assert list(found["strict"]) == [1.0, 2.0]


def test_column_that_says_nothing_of_a_condition_does_not_drop_it() -> None:
    """Blocks of a study vary different things; pushes have no place of a plank."""
    with_places = TABLE.assign(place=pd.Series([np.nan, np.nan, 0.9, 0.9, np.nan]))
    found = pairs(with_places, "controller", LEVELS, ["seed", "place"], "error")
    assert sorted(found["weighted"]) == [2.0, 4.0]
