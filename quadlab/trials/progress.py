"""How a running trial reports to the person at the terminal."""

import sys
import time
from typing import Protocol, TextIO

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn

REFRESH_S = 0.1  # [s] of wall time between two updates of the bar
LINE_INTERVAL_S = 5.0  # [s] of wall time between two plain lines


class TrialProgress(Protocol):
    """What the closed loop tells about itself; calls are cheap enough for every control tick."""

    def start(self, name: str, duration_s: float) -> None:
        """Begin a trial of ``duration_s`` simulated [s]."""
        ...

    def advance(self, time_s: float, status: str) -> None:
        """Report the simulated time in [s] and a word about the state, e.g. the mode."""
        ...

    def finish(self, status: str) -> None:
        """End with the outcome; only the first call after ``start`` does anything."""
        ...


class SilentProgress:
    """Says nothing; for tests and library use."""

    def start(self, name: str, duration_s: float) -> None:
        """Ignore the beginning."""

    def advance(self, time_s: float, status: str) -> None:
        """Ignore the step."""

    def finish(self, status: str) -> None:
        """Ignore the end."""


class _Clock:
    """Simulated against wall time, and when to show it next."""

    def __init__(self, duration_s: float, interval_s: float) -> None:
        self.duration_s = duration_s
        self.time_s = 0.0
        self._interval_s = interval_s
        self._began = self._shown = time.perf_counter()

    def due(self, time_s: float) -> bool:
        """Note the simulated time and say whether it should be shown."""
        self.time_s = time_s
        now = time.perf_counter()
        if now - self._shown < self._interval_s:
            return False
        self._shown = now
        return True

    def text(self, status: str) -> str:
        """Return time, speed and status in one line."""
        speed = self.time_s / max(time.perf_counter() - self._began, 1e-9)
        return f"{self.time_s:6.2f} / {self.duration_s:g} s  {speed:5.2f} x real time  {status}"


class PlainProgress:
    """One line every few seconds; for files, pipes and continuous integration."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._name = ""
        self._clock = _Clock(0.0, LINE_INTERVAL_S)
        self._running = False

    def start(self, name: str, duration_s: float) -> None:
        """Print that the trial begins."""
        self._name, self._clock, self._running = name, _Clock(duration_s, LINE_INTERVAL_S), True
        self._print("started")

    def advance(self, time_s: float, status: str) -> None:
        """Print a line if the last one is old enough."""
        if self._clock.due(time_s):
            self._print(self._clock.text(status))

    def finish(self, status: str) -> None:
        """Print the outcome."""
        if self._running:
            self._print(self._clock.text(status))
        self._running = False

    def _print(self, text: str) -> None:
        self._stream.write(f"{self._name}: {text}\n")
        self._stream.flush()


class BarProgress:
    """A progress bar for a terminal."""

    def __init__(self, stream: TextIO) -> None:
        columns = (TextColumn("{task.fields[name]}"), BarColumn(), TextColumn("{task.description}"))
        self._progress = Progress(*columns, console=Console(file=stream), auto_refresh=False)
        self._clock = _Clock(0.0, REFRESH_S)
        self._task = TaskID(0)
        self._running = False

    def start(self, name: str, duration_s: float) -> None:
        """Show an empty bar."""
        self._clock = _Clock(duration_s, REFRESH_S)
        self._task = self._progress.add_task(self._clock.text("started"), total=duration_s, name=name)
        self._progress.start()
        self._running = True

    def advance(self, time_s: float, status: str) -> None:
        """Move the bar if it was not moved just now."""
        if self._clock.due(time_s):
            self._draw(status)

    def finish(self, status: str) -> None:
        """Draw the bar a last time and leave it on the screen."""
        if self._running:
            self._draw(status)
            self._progress.stop()
        self._running = False

    def _draw(self, status: str) -> None:
        self._progress.update(self._task, completed=self._clock.time_s, description=self._clock.text(status))
        self._progress.refresh()


def terminal_progress(stream: TextIO | None = None) -> TrialProgress:
    """Return a bar if ``stream`` (standard error by default) is a terminal, plain lines otherwise."""
    stream = stream or sys.stderr
    return BarProgress(stream) if stream.isatty() else PlainProgress(stream)
