"""Removing what never finished; results are never removed."""

import errno
from dataclasses import dataclass
from pathlib import Path

from quadlab.analysis.inventory import EntryState, TrialEntry, trial_entries, trial_entry
from quadlab.trials.job import CONFIG_FILE, ERROR_FILE
from quadlab.trials.lock import LOCK_FILE, held_now
from quadlab.trials.manifest import MANIFEST_FILE
from quadlab.trials.recording.topics import LOG_FILE, PART_SUFFIX

_OURS = {CONFIG_FILE, MANIFEST_FILE, ERROR_FILE, LOG_FILE, LOCK_FILE}
_REMOVABLE = {EntryState.FAILED, EntryState.UNFINISHED}


@dataclass(frozen=True)
class Litter:
    """What can be removed of a trial.

    Attributes:
        directory: of the trial.
        files: in it; a trial never wrote others.
        whole: whether the directory goes too; False where the trial has finished, or holds a file of somebody else.
    """

    directory: Path
    files: tuple[Path, ...]
    whole: bool

    def remove(self) -> str | None:
        """Remove it and return None, or one line why it stays: a process runs the trial now, or has changed it since.

        The directory goes last, when it is empty and no longer held: an open file, deleted or not, keeps it on NFS.
        """
        try:
            with held_now(self.directory) as busy:
                reason = busy or self._remove_files()
            if reason is None and self.whole:
                self.directory.rmdir()
        except FileNotFoundError:  # somebody else was faster
            return None
        except OSError as error:
            if error.errno != errno.ENOTEMPTY:
                raise
            return "something new is in it"
        return reason

    def _remove_files(self) -> str | None:
        now = _litter_of(trial_entry(self.directory, held=True))
        if now is None or (now.whole, now.unlocked) != (self.whole, self.unlocked):
            return "it has changed meanwhile"
        for path in self.unlocked:
            path.unlink(missing_ok=True)
        return None

    @property
    def unlocked(self) -> tuple[Path, ...]:
        """The files without the one that is locked, which whoever holds the directory removes."""
        return tuple(path for path in self.files if path.name != LOCK_FILE)

    def __str__(self) -> str:
        return str(self.directory) if self.whole else ", ".join(map(str, self.files))


def find_litter(folder: Path) -> list[Litter]:
    """Return what trials below ``folder`` left that never finished and does not run now, in the order of their ids.

    Raises:
        LogError: if there is no such folder.
    """
    found = (_litter_of(entry) for entry in trial_entries(folder))
    return [litter for litter in found if litter is not None]


def _litter_of(entry: TrialEntry) -> Litter | None:
    present = sorted(entry.directory.iterdir())
    if entry.state in _REMOVABLE:
        ours = tuple(path for path in present if _is_ours(path))
        return Litter(entry.directory, ours, len(ours) == len(present)) if ours or not present else None
    halves = tuple(path for path in present if _is_part(path))
    return Litter(entry.directory, halves, whole=False) if halves and entry.state is EntryState.FINISHED else None


def _is_ours(path: Path) -> bool:
    return path.is_file() and (path.name in _OURS or _is_part(path))


def _is_part(path: Path) -> bool:
    return path.is_file() and path.suffix == PART_SUFFIX
