"""What a person, a pipe and a test see of a running trial."""

import io

import pytest

from quadlab.trials.progress import BarProgress, PlainProgress, SilentProgress, TrialProgress, terminal_progress


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_pipe_gets_plain_lines_and_terminal_a_bar() -> None:
    assert isinstance(terminal_progress(io.StringIO()), PlainProgress)
    assert isinstance(terminal_progress(_Terminal()), BarProgress)


@pytest.mark.parametrize("stream", [io.StringIO(), _Terminal()], ids=["pipe", "terminal"])
def test_shows_name_simulated_time_and_outcome(stream: io.StringIO) -> None:
    progress = terminal_progress(stream)
    progress.start("anymal_b trot", 2.0)
    for tick in range(801):
        progress.advance(tick / 400.0, "running")
    progress.finish("completed")
    text = stream.getvalue()
    assert "anymal_b trot" in text
    assert "2.00 / 2 s" in text
    assert "x real time" in text
    assert "completed" in text


def test_plain_progress_does_not_flood_the_log() -> None:
    stream = io.StringIO()
    progress = PlainProgress(stream)
    progress.start("x", 2.0)
    for tick in range(801):
        progress.advance(tick / 400.0, "running")
    assert stream.getvalue().count("\n") <= 2


@pytest.mark.parametrize("kind", [PlainProgress, BarProgress])
def test_only_the_first_end_counts(kind: type[PlainProgress] | type[BarProgress]) -> None:
    stream = io.StringIO()
    progress = kind(stream)
    progress.finish("never started")
    progress.start("x", 1.0)
    progress.finish("fell")
    progress.finish("error")
    assert "fell" in stream.getvalue()
    assert "never started" not in stream.getvalue()
    assert "error" not in stream.getvalue()


def test_silence() -> None:
    progress: TrialProgress = SilentProgress()
    progress.start("x", 1.0)
    progress.advance(0.5, "running")
    progress.finish("completed")
