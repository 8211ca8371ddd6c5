"""What is in a folder of trials: finished, failed, half-written, running, and from which version of the code."""

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from pathlib import Path
from typing import Any

import yaml

from quadlab.errors import LogError
from quadlab.trials.identity import ID_LENGTH
from quadlab.trials.job import CONFIG_FILE, ERROR_FILE
from quadlab.trials.lock import is_running
from quadlab.trials.manifest import MANIFEST_FILE
from quadlab.trials.result import RESULT_FILE, TrialResult, read_result
from quadlab.yaml_text import load_yaml

_TRIAL_NAME = re.compile(rf"[0-9a-f]{{{ID_LENGTH}}}")


class EntryState(StrEnum):
    """How far a trial is."""

    FINISHED = "finished"
    UNREADABLE = "unreadable"
    """It has a result that cannot be read."""
    RUNNING = "running"
    FAILED = "failed"
    """The program failed or its process was killed; there is an ``error.json``."""
    UNFINISHED = "half-written"
    """It began and left neither a result nor an error."""


@dataclass(frozen=True)
class TrialEntry:
    """A trial's directory.

    Attributes:
        directory: named after the trial.
        state: how far it is.
        result: if it has finished.
        reason: one line if it has failed or its result cannot be read.
    """

    directory: Path
    state: EntryState
    result: TrialResult | None = None
    reason: str = ""

    @property
    def trial_id(self) -> str:
        """The name of the trial."""
        return self.directory.name

    @cached_property
    def config(self) -> Mapping[str, Any]:
        """Its configuration as written, read when first asked for; empty if that cannot be read."""
        return _mapping(self.directory / CONFIG_FILE, load_yaml)

    @cached_property
    def commit(self) -> str | None:
        """The commit of the code that ran it; None if unknown."""
        git = _mapping(self.directory / MANIFEST_FILE, json.loads).get("git")
        commit = git.get("commit") if isinstance(git, dict) else None
        return commit if isinstance(commit, str) else None


def trial_entries(folder: Path) -> list[TrialEntry]:
    """Return what is known of every trial below ``folder``, sorted by trial id; one may be there under several tags.

    Raises:
        LogError: if there is no such folder.
    """
    if not folder.is_dir():
        raise LogError(f"{folder}: no such folder; expected one with trials in it, e.g. results/trials")
    found = [path for path in folder.rglob("*") if _TRIAL_NAME.fullmatch(path.name) and path.is_dir()]
    return [trial_entry(path) for path in sorted(found, key=lambda path: (path.name, path))]


def trial_entry(directory: Path, *, held: bool = False) -> TrialEntry:
    """Return what is known of the trial in ``directory``, which nobody else runs if this process holds it."""
    return TrialEntry(directory, *_state(directory, held))


def _state(directory: Path, held: bool) -> tuple[EntryState, TrialResult | None, str]:
    if (directory / RESULT_FILE).is_file():
        try:
            return EntryState.FINISHED, read_result(directory), ""
        except LogError as error:
            return EntryState.UNREADABLE, None, str(error)
    if not held and is_running(directory):
        return EntryState.RUNNING, None, ""
    if (directory / ERROR_FILE).is_file():
        error_file = _mapping(directory / ERROR_FILE, json.loads)
        return EntryState.FAILED, None, f"{error_file.get('type', 'error')}: {error_file.get('message', 'unknown')}"
    return EntryState.UNFINISHED, None, ""


def _mapping(path: Path, parse: Any) -> dict[str, Any]:
    """Return the content of a file, empty if it is not there or not readable: other files say what happened."""
    try:
        content = parse(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, yaml.YAMLError):
        return {}
    return content if isinstance(content, dict) else {}
