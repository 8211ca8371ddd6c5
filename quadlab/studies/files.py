"""Where a study keeps what, below ``results/<study>/``."""

import hashlib
import json
from dataclasses import dataclass
from functools import lru_cache
from glob import escape
from pathlib import Path
from typing import Any

import yaml

from quadlab.paths import CONF_DIR
from quadlab.studies.config import TraceConfig
from quadlab.trials.files import write_json
from quadlab.yaml_text import load_yaml

_NOT_OF_TRIALS = {"study", "launcher"}
"""Folders of configuration that change no trial; a study's own jobs are named after what they override."""


@dataclass(frozen=True)
class StudyFolder:
    """The files of one study.

    Attributes:
        path: ``<results>/<study>``.
    """

    path: Path

    @property
    def table(self) -> Path:
        """One row a job; tracked."""
        return self.path / "table.csv"

    @property
    def limits(self) -> Path:
        """One row a search; tracked."""
        return self.path / "limits.csv"

    @property
    def report(self) -> Path:
        """The table for people; tracked."""
        return self.path / "report.md"

    @property
    def manifest(self) -> Path:
        """Provenance; tracked."""
        return self.path / "manifest.json"

    def trace(self, name: str) -> Path:
        """Curves of one trial; tracked."""
        return self.path / "traces" / f"{name}.parquet"

    def events(self, name: str) -> Path:
        """What happened in that trial; tracked."""
        return self.path / "traces" / f"{name}.events.csv"

    def snapshot(self, name: str, number: int) -> Path:
        """A picture of that trial; tracked."""
        return self.path / "traces" / f"{name}.{number:02d}.png"

    def plan(self, name: str) -> Path:
        """A plan, also that of a traced trial; tracked."""
        return self.path / "plans" / f"{name}.npz"

    def row(self, identifier: str) -> Path:
        """What is remembered of one job; not tracked."""
        return self.path / "rows" / f"{identifier}.json"


def remove_trace(name: str, folder: StudyFolder) -> None:
    """Remove what ``write_trace`` left under a name, however many pictures it were."""
    pictures = (folder.path / "traces").glob(f"{escape(name)}.[0-9][0-9].png")
    for path in (folder.trace(name), folder.events(name), folder.plan(name), *pictures):
        path.unlink(missing_ok=True)


def trace_files(trace: TraceConfig, folder: StudyFolder) -> list[Path]:
    """Return the files that ``write_trace`` leaves."""
    pictures = [folder.snapshot(trace.name, number) for number in range(len(trace.snapshots_s))]
    return [folder.trace(trace.name), folder.events(trace.name), folder.plan(trace.name), *pictures]


def read_row(folder: StudyFolder, identifier: str, settings: str) -> dict[str, Any] | None:
    """Return the remembered row of a job, or None if there is none that is still good.

    Args:
        folder: of the study.
        identifier: of the condition.
        settings: what the row depends on, as given to ``write_row``.
    """
    remembered_settings, row = _read(folder.row(identifier))
    return row if remembered_settings == settings else None


def last_row(folder: StudyFolder, identifier: str) -> dict[str, Any] | None:
    """Return the last row of a job that was remembered, whatever it depended on, or None."""
    return _read(folder.row(identifier))[1]


def _read(path: Path) -> tuple[object, dict[str, Any] | None]:
    """Return settings and row in a file; None if there is none, or if it is damaged: it is made again."""
    if not path.is_file():
        return None, None
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except ValueError:
        return None, None
    if not isinstance(content, dict) or not isinstance(content.get("row"), dict):
        return None, None
    return content.get("settings"), content["row"]


def write_row(folder: StudyFolder, identifier: str, settings: str, row: dict[str, Any]) -> None:
    """Remember the row of a job in one step."""
    write_json(folder.row(identifier), {"settings": settings, "row": row})


def configuration_hash() -> str:
    """Return one hash of what the YAML files say that trials are made of: rows remembered under another one are stale.

    Comments do not count, nor do other studies and how sweeps are launched.
    """
    paths = (
        path for path in sorted(CONF_DIR.rglob("*.yaml")) if path.relative_to(CONF_DIR).parts[0] not in _NOT_OF_TRIALS
    )
    return _hash_of(tuple((path, _version(path)) for path in paths))


def _version(path: Path) -> tuple[int, ...]:
    """Return numbers that change when the file does."""
    status = path.stat()
    return status.st_mtime_ns, status.st_ctime_ns, status.st_size, status.st_ino


@lru_cache(maxsize=1)
def _hash_of(files: tuple[tuple[Path, tuple[int, ...]], ...]) -> str:
    """Return the hash of files, each with its version; they are read once as long as none of them changes."""
    digest = hashlib.sha256()
    for path, _ in files:
        digest.update(json.dumps([str(path.relative_to(CONF_DIR)), *_content(path)], default=str).encode())
    return digest.hexdigest()


def _content(path: Path) -> list[Any]:
    """Return what Hydra reads of a file; as its text if it is no YAML, which is said elsewhere."""
    text = path.read_text(encoding="utf-8", errors="replace")
    directives = [line for line in text.splitlines() if line.startswith("# @package")]
    try:
        return [directives, load_yaml(text)]
    except (yaml.YAMLError, ValueError):
        return [text]


def file_hash(path: Path) -> str:
    """Return the SHA-256 of a file in hexadecimal."""
    return hashlib.sha256(path.read_bytes()).hexdigest()
