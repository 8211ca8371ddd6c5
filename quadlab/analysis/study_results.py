"""What studies left, for figures and statistics; nothing is run here."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from quadlab.errors import LogError
from quadlab.planners.plan import MotionPlan
from quadlab.planners.plan_io import load_plan


@dataclass(frozen=True)
class StudyResults:
    """The tracked files of all studies.

    Attributes:
        folder: of all results.
    """

    folder: Path

    def table(self, study: str, columns: Sequence[str] = ()) -> pd.DataFrame:
        """Return one row a job: its levels, then its numbers.

        Raises:
            LogError: if the study has not been run, or one of ``columns`` is missing as it had another form then.
        """
        return self._csv(study, "table.csv", columns)

    def limits(self, study: str, columns: Sequence[str] = ()) -> pd.DataFrame:
        """Return one row a search: its levels and the largest value survived.

        Raises:
            LogError: if the study has not been run, searches for nothing, or one of ``columns`` is missing as it had
                another form then.
        """
        return self._csv(study, "limits.csv", columns)

    def trace(self, study: str, name: str) -> pd.DataFrame:
        """Return the kept curves of one trial by time in [s]; columns are named ``<table>.<column>``.

        Raises:
            LogError: if there are none of that name.
        """
        return pd.read_parquet(self._file(study, f"traces/{name}.parquet"))

    def events(self, study: str, name: str) -> pd.DataFrame:
        """Return what happened in that trial by time in [s]: columns ``level`` and ``message``.

        Raises:
            LogError: if nothing of that name was kept.
        """
        return pd.read_csv(self._file(study, f"traces/{name}.events.csv"), index_col=0)

    def plan(self, study: str, name: str) -> MotionPlan:
        """Return a kept plan.

        Raises:
            LogError: if there is none of that name.
        """
        return load_plan(self._file(study, f"plans/{name}.npz"))

    def snapshots(self, study: str, name: str) -> list[Path]:
        """Return the pictures of a trial in the order of time."""
        return sorted((self.folder / study / "traces").glob(f"{name}.[0-9][0-9].png"))

    def _csv(self, study: str, name: str, columns: Sequence[str]) -> pd.DataFrame:
        """Return a table that has some columns."""
        table = pd.read_csv(self._file(study, name))
        missing = [column for column in columns if column not in table]
        if missing:
            raise LogError(
                f"{study}/{name}: no column '{missing[0]}', the study has changed since it was run; "
                f"python experiments/run_study.py {study} makes it anew"
            )
        return table

    def _file(self, study: str, name: str) -> Path:
        path = self.folder / study / name
        if not path.is_file():
            raise LogError(
                f"{path.relative_to(self.folder.parent)}: not there; python experiments/run_study.py {study} makes it"
            )
        return path
