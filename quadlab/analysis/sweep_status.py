"""What is done of the sweeps into a folder, and what is not."""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from quadlab.analysis.collection import COMMIT_LENGTH
from quadlab.analysis.inventory import EntryState, TrialEntry, trial_entries
from quadlab.errors import LogError
from quadlab.paths import checkout_dir
from quadlab.sweeps.record import sweep_records
from quadlab.trials.job import CONFIG_FILE
from quadlab.trials.manifest import git_state

_NO_CONFIG = "config unreadable"


@dataclass(frozen=True)
class SweepStatus:
    """The trials of a folder.

    Attributes:
        folder: that was looked at.
        entries: all trials that are there.
        records: what each sweep asked for: names by the directories of the trials.
        commit: of the code now; None if unknown.
    """

    folder: Path
    entries: tuple[TrialEntry, ...]
    records: Mapping[Path, Mapping[Path, str]]
    commit: str | None

    @cached_property
    def names(self) -> dict[Path, str]:
        """Names of the trials that sweeps asked for, by directory: the same trial may be wanted under several tags."""
        return {directory: name for record in self.records.values() for directory, name in record.items()}

    @cached_property
    def missing(self) -> list[Path]:
        """Directories of trials that were asked for and never began."""
        return sorted(set(self.names) - {entry.directory for entry in self.entries})

    @property
    def stale(self) -> list[TrialEntry]:
        """Finished trials whose code was another commit than now."""
        done = [entry for entry in self.entries if entry.state is EntryState.FINISHED]
        return [entry for entry in done if self.commit and entry.commit and entry.commit != self.commit]

    @property
    def without_config(self) -> list[TrialEntry]:
        """Finished trials of which nobody can say any more what they were."""
        return [entry for entry in self.entries if entry.state is EntryState.FINISHED and not entry.config]

    @property
    def complete(self) -> bool:
        """Whether every trial has a result of the code as it is now, and its configuration."""
        finished = all(entry.state is EntryState.FINISHED for entry in self.entries)
        return finished and not (self.missing or self.stale or self.without_config)

    def lines(self) -> Iterator[str]:
        """Yield the counts in one line, then one line for each trial that is not finished or is stale."""
        yield f"{self.folder}: {self._counts()}"
        for entry in self.entries:
            if entry.state is not EntryState.FINISHED:
                yield self._line(entry.state.value, entry.directory, entry.reason)
        for directory in self.missing:
            yield self._line("missing", directory, "")
        for path, record in self.records.items():
            if wanted := len(record.keys() & set(self.missing)):
                yield f"  {path} asked for {wanted} of the missing; remove it if they are not wanted any more"
        for entry in self.without_config:
            yield self._line(
                _NO_CONFIG, entry.directory, f"no {CONFIG_FILE} that can be read; force=true runs it again"
            )
        for entry in self.stale:
            yield self._line("stale", entry.directory, f"commit {_short(entry.commit)}, now {_short(self.commit)}")

    def _counts(self) -> str:
        outcomes = Counter(entry.result.status.value for entry in self.entries if entry.result)
        finished = f"{outcomes.total()} {EntryState.FINISHED}"
        if outcomes:
            finished += f" ({', '.join(f'{count} {status}' for status, count in sorted(outcomes.items()))})"
        states = Counter(entry.state.value for entry in self.entries if entry.result is None)
        rest: dict[str, int] = {
            **states,
            "missing": len(self.missing),
            _NO_CONFIG: len(self.without_config),
            "stale": len(self.stale),
        }
        asked = [f"{len(self.names)} asked for"] if self.names else []
        return ", ".join([*asked, finished, *(f"{count} {state}" for state, count in rest.items() if count)])

    def _line(self, word: str, directory: Path, reason: str) -> str:
        trial, name = str(directory.relative_to(self.folder)), self.names.get(directory)
        named = trial if name is None else f"{trial} ({name})"
        return f"  {word:12}  {named}{': ' if reason else ''}{reason}"


def sweep_status(folder: Path) -> SweepStatus:
    """Return the status of ``folder``, usually ``results/<tag>``; of ``results``, that of all tags in it.

    Raises:
        LogError: if it is not there, holds no trials and was never meant to, or holds what cannot be read.
    """
    entries, records, git = tuple(trial_entries(folder)), sweep_records(folder), git_state(checkout_dir())
    if not entries and not records:
        raise LogError(f"{folder}: no trial in it, and no sweep asked for one; expected results/<tag>")
    return SweepStatus(folder, entries, records, git["commit"] if git else None)


def _short(commit: str | None) -> str:
    return str(commit)[:COMMIT_LENGTH]
