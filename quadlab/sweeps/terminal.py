"""How a running sweep reports to the person at the terminal."""

import sys
import time
from typing import TextIO

from rich.console import Console, Group
from rich.live import Live
from rich.table import Table
from rich.text import Text

from quadlab.sweeps.count import SweepCount, duration_text, outcome_text
from quadlab.sweeps.progress import SweepProgress
from quadlab.trials.job import JobOutcome
from quadlab.trials.result import TrialStatus

REFRESH_PER_S = 4.0  # [1/s] of the live table


class PlainSweep:
    """One line a trial; for files, pipes and continuous integration."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._count = SweepCount(0, 1)

    def begin(self, total: int, workers: int) -> None:
        """Print how much there is to do."""
        self._count = SweepCount(total, workers)
        self._print(f"{total} trials, {workers} at a time")

    def started(self, name: str) -> None:
        """Remember it for the next line."""
        self._count.start(name)

    def ended(self, name: str, job: JobOutcome) -> None:
        """Print the outcome and how many are left."""
        self._count.end(name, job)
        self._print(f"[{self._count.done}/{self._count.total}] {name}: {outcome_text(job)}")

    def notice(self, text: str) -> None:
        """Print it."""
        self._print(text)

    def end(self) -> None:
        """Print the counts."""
        self._print(self._count.summary())

    def _print(self, text: str) -> None:
        self._stream.write(f"sweep: {text}\n")
        self._stream.flush()


class LiveSweep:
    """A table of what runs that is always up to date, and a line above it for each trial that did not complete."""

    def __init__(self, stream: TextIO) -> None:
        self._console = Console(file=stream)
        self._count = SweepCount(0, 1)
        self._live = Live(console=self._console, get_renderable=self._table, refresh_per_second=REFRESH_PER_S)

    def begin(self, total: int, workers: int) -> None:
        """Show the table."""
        self._count = SweepCount(total, workers)
        self._live.start()

    def started(self, name: str) -> None:
        """Show that it runs."""
        self._count.start(name)

    def ended(self, name: str, job: JobOutcome) -> None:
        """Count it, and leave a line if it did not complete."""
        self._count.end(name, job)
        if job.result is None or job.result.status is not TrialStatus.COMPLETED:
            style = "red" if job.result is None else "yellow"
            self._console.print(Text(f"{name}: {outcome_text(job)}", style))

    def notice(self, text: str) -> None:
        """Leave a line."""
        self._console.print(Text(text, "dim"))

    def end(self) -> None:
        """Leave the counts on the screen."""
        self._live.stop()

    def _table(self) -> Group:
        running = Table.grid(padding=(0, 2))
        for name, began_s in dict(self._count.running).items():
            running.add_row(duration_text(time.monotonic() - began_s), Text(name))
        return Group(Text(self._count.summary(), "bold"), running)


def terminal_sweep(stream: TextIO | None = None) -> SweepProgress:
    """Return a live table if ``stream`` (standard error by default) is a terminal, plain lines otherwise."""
    stream = stream or sys.stderr
    return LiveSweep(stream) if stream.isatty() else PlainSweep(stream)
