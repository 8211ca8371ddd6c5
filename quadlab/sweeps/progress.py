"""What a running sweep tells, and to whom."""

from typing import Protocol

from quadlab.trials.job import JobOutcome


class SweepProgress(Protocol):
    """What a sweep tells about itself."""

    def begin(self, total: int, workers: int) -> None:
        """Start with ``total`` trials, ``workers`` at a time."""
        ...

    def started(self, name: str) -> None:
        """Report that a trial runs."""
        ...

    def ended(self, name: str, job: JobOutcome) -> None:
        """Report what came of a trial."""
        ...

    def notice(self, text: str) -> None:
        """Report something that concerns no single trial."""
        ...

    def end(self) -> None:
        """Report that the sweep is over or was left."""
        ...


class SilentSweep:
    """Says nothing; for tests and library use."""

    def begin(self, total: int, workers: int) -> None:
        """Ignore the beginning."""

    def started(self, name: str) -> None:
        """Ignore the start."""

    def ended(self, name: str, job: JobOutcome) -> None:
        """Ignore the outcome."""

    def notice(self, text: str) -> None:
        """Ignore the notice."""

    def end(self) -> None:
        """Ignore the end."""
