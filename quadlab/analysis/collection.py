"""The trials of a folder as a table, and what somebody who reads numbers out of it has to know."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from quadlab.trials.job import CONFIG_FILE
from quadlab.trials.result import TrialStatus

COMMIT = "commit"
COMMIT_LENGTH = 10
_SHOWN = 5


@dataclass(frozen=True)
class Collection:
    """What was collected.

    Attributes:
        table: one row for each trial that has an outcome, see ``collect_trials``.
        without_config: ids of the rows whose configuration cannot be read: what was varied in them is unknown.
        left_out: how many trials have no outcome yet, by what became of them so far, e.g. "half-written".
    """

    table: pd.DataFrame
    without_config: tuple[str, ...]
    left_out: Mapping[str, int]

    @property
    def comparable(self) -> pd.DataFrame:
        """The rows of which is known what was varied."""
        return self.table.drop(index=list(self.without_config))

    def notes(self) -> Iterator[str]:
        """Yield what is not as it should be, a line each: errors, what was left out, unlike versions of the code."""
        counts = [f"{count} {state} left out" for state, count in sorted(self.left_out.items())]
        failed = (self.table["status"] == TrialStatus.ERROR.value).astype(bool)
        if failed.any():
            counts.insert(0, f"{failed.sum()} ended in an error")
        if counts:
            yield ", ".join(counts)
        if self.without_config:
            yield f"no {CONFIG_FILE} that can be read, left out of comparisons: {_some(self.without_config)}"
        commits = sorted(self.table[COMMIT][~failed].fillna("unknown").unique())
        if len(commits) > 1:
            yield f"trials of {len(commits)} commits: {_some([commit[:COMMIT_LENGTH] for commit in commits])}"


def _some(names: Sequence[str]) -> str:
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return ", ".join(names[:_SHOWN]) + more
