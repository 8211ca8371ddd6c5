"""Removing what never finished; results are never removed."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from quadlab.analysis.inventory import EntryState, trial_entries
from quadlab.trials.job import CONFIG_FILE, ERROR_FILE
from quadlab.trials.lock import LOCK_FILE
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

    def remove(self) -> None:
        """Remove it."""
        for path in self.files:
            path.unlink(missing_ok=True)
        if self.whole:
            self.directory.rmdir()

    def __str__(self) -> str:
        return str(self.directory) if self.whole else ", ".join(map(str, self.files))


def find_litter(folder: Path) -> list[Litter]:
    """Return what trials below ``folder`` left that never finished and does not run now, oldest id first.

    Raises:
        LogError: if there is no such folder.
    """
    return list(_litter(folder))


def _litter(folder: Path) -> Iterator[Litter]:
    for entry in trial_entries(folder):
        present = sorted(entry.directory.iterdir())
        if entry.state in _REMOVABLE:
            ours = tuple(path for path in present if _is_ours(path))
            if ours or not present:
                yield Litter(entry.directory, ours, whole=len(ours) == len(present))
        elif entry.state is EntryState.FINISHED and (halves := tuple(path for path in present if _is_part(path))):
            yield Litter(entry.directory, halves, whole=False)


def _is_ours(path: Path) -> bool:
    return path.is_file() and (path.name in _OURS or _is_part(path))


def _is_part(path: Path) -> bool:
    return path.is_file() and path.suffix == PART_SUFFIX
