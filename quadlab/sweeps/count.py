"""How far a sweep is, in numbers and words."""

import time
from collections import Counter

from quadlab.trials.job import JobOutcome

FAILURE = "failure"
"""Counted in place of a status where the program failed."""


class SweepCount:
    """How many trials are done, how they ended, and how long the rest will take."""

    def __init__(self, total: int, workers: int) -> None:
        self.total = total
        self.workers = workers
        self.by_status: Counter[str] = Counter()
        self.skipped = 0
        self.running: dict[str, float] = {}
        self._began_s = time.monotonic()
        self._first_start_s: float | None = None

    def start(self, name: str) -> None:
        """Count a trial that runs."""
        self.running[name] = time.monotonic()
        self._first_start_s = self._first_start_s or self.running[name]

    def end(self, name: str, job: JobOutcome) -> None:
        """Count a trial that is over."""
        self.running.pop(name, None)
        self.by_status[job.result.status.value if job.result else FAILURE] += 1
        self.skipped += job.skipped

    @property
    def done(self) -> int:
        """Trials that are over, whatever their outcome."""
        return self.by_status.total()

    @property
    def elapsed_s(self) -> float:
        """Wall time since the beginning in [s]."""
        return time.monotonic() - self._began_s

    @property
    def left_s(self) -> float | None:
        """Wall time that the rest will take at the rate so far, in [s]; None as long as nobody can know."""
        ran = self.done - self.skipped
        if self._first_start_s is None or ran == 0:
            return None
        return (time.monotonic() - self._first_start_s) / ran * (self.total - self.done)

    def summary(self) -> str:
        """Return the counts and times in one line."""
        words = [f"{self.done} of {self.total} done"]
        words += [f"{count} {status}" for status, count in sorted(self.by_status.items())]
        words += [f"{self.skipped} from before"] if self.skipped else []
        words += [f"{len(self.running)} running"] if self.running else []
        words += [f"{duration_text(self.elapsed_s)} so far"]
        words += [f"{duration_text(self.left_s)} left"] if self.left_s and self.done < self.total else []
        return ", ".join(words)


def outcome_text(job: JobOutcome) -> str:
    """Return status and reason of a trial in one line."""
    if job.result is None:
        return job.failure or FAILURE
    before = " (from before)" if job.skipped else ""
    return f"{job.result.status}{before}, {job.result.status_reason}"


def duration_text(seconds: float) -> str:
    """Return a wall time like "0:07" or "2:03:59"."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
