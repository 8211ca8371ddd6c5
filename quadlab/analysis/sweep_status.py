"""What is done of the sweeps into a folder, and what is not."""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from quadlab.analysis.inventory import EntryState, TrialEntry, trial_entries
from quadlab.paths import checkout_dir
from quadlab.sweeps.record import asked_for
from quadlab.trials.manifest import git_state

COMMIT_LENGTH = 10


@dataclass(frozen=True)
class SweepStatus:
    """The trials of a folder.

    Attributes:
        folder: that was looked at.
        entries: all trials that are there.
        names: of the trials that sweeps asked for, by trial id.
        commit: of the code now; None if unknown.
    """

    folder: Path
    entries: tuple[TrialEntry, ...]
    names: Mapping[str, str]
    commit: str | None

    @property
    def missing(self) -> list[str]:
        """Trials that were asked for and never began."""
        return sorted(set(self.names) - {entry.trial_id for entry in self.entries})

    @property
    def stale(self) -> list[TrialEntry]:
        """Finished trials whose code was another commit than now."""
        done = [entry for entry in self.entries if entry.state is EntryState.FINISHED]
        return [entry for entry in done if self.commit and entry.commit and entry.commit != self.commit]

    @property
    def complete(self) -> bool:
        """Whether every trial has a result of the code as it is now."""
        return not self.missing and not self.stale and all(e.state is EntryState.FINISHED for e in self.entries)

    def lines(self) -> Iterator[str]:
        """Yield the counts in one line, then one line for each trial that is not finished or is stale."""
        yield f"{self.folder}: {self._counts()}"
        for entry in self.entries:
            if entry.state is not EntryState.FINISHED:
                yield self._line(entry.state.value, entry.trial_id, entry.reason)
        for name in self.missing:
            yield self._line("missing", name, "")
        for entry in self.stale:
            yield self._line("stale", entry.trial_id, f"commit {_short(entry.commit)}, now {_short(self.commit)}")

    def _counts(self) -> str:
        outcomes = Counter(entry.result.status.value for entry in self.entries if entry.result)
        finished = f"{outcomes.total()} {EntryState.FINISHED}"
        if outcomes:
            finished += f" ({', '.join(f'{count} {status}' for status, count in sorted(outcomes.items()))})"
        states = Counter(entry.state.value for entry in self.entries if entry.result is None)
        rest: dict[str, int] = {**states, "missing": len(self.missing), "stale": len(self.stale)}
        asked = [f"{len(self.names)} asked for"] if self.names else []
        return ", ".join([*asked, finished, *(f"{count} {state}" for state, count in rest.items() if count)])

    def _line(self, word: str, trial: str, reason: str) -> str:
        named = f"{trial} ({self.names[trial]})" if trial in self.names else trial
        return f"  {word:12}  {named}{': ' if reason else ''}{reason}"


def sweep_status(folder: Path) -> SweepStatus:
    """Return the status of ``folder``, usually ``results/<tag>``.

    Raises:
        LogError: if it is not there or holds what cannot be read.
    """
    git = git_state(checkout_dir())
    return SweepStatus(folder, tuple(trial_entries(folder)), asked_for(folder), git["commit"] if git else None)


def _short(commit: str | None) -> str:
    return str(commit)[:COMMIT_LENGTH]
