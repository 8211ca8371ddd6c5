"""What a sweep asked for, beside its trials, so that somebody can see later what is missing."""

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from quadlab.errors import LogError
from quadlab.sweeps.trial_pool import SweepTrial
from quadlab.trials.config import RunOptions
from quadlab.trials.files import write_json
from quadlab.trials.identity import ID_LENGTH, trial_id

FOLDER = "sweeps"
"""In the folder of a tag: a file for each different sweep."""

_NAMES = TypeAdapter(dict[str, str])


def record_sweep(trials: Sequence[SweepTrial], options: RunOptions) -> list[Path]:
    """Write which trials were asked for into the folder of each tag and return the paths.

    The same sweep gives the same file, on every machine that runs a part of it.
    """
    by_tag: dict[str, dict[str, str]] = {}
    for trial in trials:
        by_tag.setdefault(trial.config.tag, {})[trial_id(trial.config)] = trial.name
    return [_write(Path(options.results_dir) / tag / FOLDER, names) for tag, names in by_tag.items()]


def sweep_records(folder: Path) -> dict[Path, dict[Path, str]]:
    """Return the record of each sweep into ``folder`` or a tag below it: the names of its trials, by their directories.

    Empty if no sweep is known.

    Raises:
        LogError: if the record of a sweep cannot be read.
    """
    return {path: _read(path) for path in sorted(folder.rglob(f"{FOLDER}/*.json"))}


def _read(path: Path) -> dict[Path, str]:
    tag = path.parent.parent
    try:
        return {tag / trial: name for trial, name in _NAMES.validate_json(path.read_bytes()).items()}
    except ValidationError as error:
        reason = error.errors()[0]["msg"]
        raise LogError(f"{path}: not the record of a sweep ({reason}); remove it") from error


def _write(folder: Path, names: Mapping[str, str]) -> Path:
    key = hashlib.sha256("".join(sorted(names)).encode()).hexdigest()[:ID_LENGTH]
    path = folder / f"{key}.json"
    if not path.is_file():
        write_json(path, dict(names))
    return path
