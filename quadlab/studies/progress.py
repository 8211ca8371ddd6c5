"""How far a set of studies has come, and how long the rest may take."""

import sys
import time
from dataclasses import dataclass, field
from typing import Any, TextIO

from quadlab.studies.rows import FAILURE
from quadlab.trials.result import TrialStatus

GOOD = {TrialStatus.COMPLETED.value, "solved"}


@dataclass
class StudyProgress:
    """Counts jobs and prints one line for each that is done.

    Attributes:
        stream: where to print.
        total: jobs known so far; a search adds its probes as it goes.
        done: of these, by this run or before.
    """

    stream: TextIO = field(default_factory=lambda: sys.stdout)
    total: int = 0
    done: int = 0
    _ran: int = 0
    _began: float = field(default_factory=time.perf_counter)

    def expect(self, jobs: int) -> None:
        """Add to the number of jobs to do."""
        self.total += jobs

    def skip(self) -> None:
        """Count a job that was done before."""
        self.done += 1

    def finish(self, name: str, row: dict[str, Any]) -> None:
        """Count a job that has just been done and say what came of it."""
        self.done += 1
        self._ran += 1
        outcome = row["status"] if row["status"] in GOOD else f"{row['status']}: {row.get(FAILURE)}"
        self.say(f"[{self.done}/{self.total}, {self._time_left()}] {name}: {outcome}")

    def say(self, line: str) -> None:
        """Print a line."""
        self.stream.write(f"{line}\n")
        self.stream.flush()

    def _time_left(self) -> str:
        elapsed = time.perf_counter() - self._began
        seconds = elapsed / max(self._ran, 1) * (self.total - self.done)
        return f"{seconds / 60:.0f} min left" if seconds >= 90 else f"{seconds:.0f} s left"
