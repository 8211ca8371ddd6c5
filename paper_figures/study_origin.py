"""Where the numbers of a study come from, in words, out of its manifest."""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from quadlab.analysis.study_results import StudyResults
from quadlab.studies.config import load_study

HASH_LENGTH = 10  # hexadecimal digits shown


@dataclass(frozen=True)
class Origin:
    """Where the numbers of a study come from.

    Attributes:
        study: its name.
        title: what it is.
        jobs: how many.
        code: commits that ran them.
        machine: processor.
        environment: variables that change results or speed.
        configuration: shortened hash of all YAML files.
        lock: shortened hash of the lock file.
        packages: all of them with their versions.
    """

    study: str
    title: str
    jobs: int
    code: str
    machine: str
    environment: str
    configuration: str
    lock: str
    packages: str


def study_origins(studies: Iterable[str], results: StudyResults) -> list[Origin]:
    """Return one entry a study that has been run."""
    paths = {study: results.folder / study / "manifest.json" for study in studies}
    return [_origin(study, json.loads(path.read_text("utf-8"))) for study, path in paths.items() if path.is_file()]


def _origin(study: str, manifest: dict[str, Any]) -> Origin:
    cpu = manifest["cpu"]
    return Origin(
        study=study,
        title=load_study(study).title,
        jobs=manifest["jobs"],
        code=code_state(manifest),
        machine=f"{cpu['model'] or 'unknown processor'}, {cpu['cores']} cores, {' '.join(cpu['flags'])}",
        environment=_pairs(manifest["environment"], "=") or "-",
        configuration=manifest["configuration_sha256"][:HASH_LENGTH],
        lock=(manifest["lock_sha256"] or "none")[:HASH_LENGTH],
        packages=_pairs(manifest["packages"], " "),
    )


def code_state(manifest: dict[str, Any]) -> str:
    """Return which commits ran the jobs, e.g. "commit 8220b05d52", and whether files differed from them.

    Several commits stand with their numbers of jobs. Jobs that run no trial remember no commit; theirs is the one at
    which the table was written.
    """
    git = manifest["git"] or {}
    changes = ", with local changes" if git.get("dirty") else ""
    return _commits(manifest["commits"] or {git.get("commit", "unknown"): manifest.get("jobs", 0)}) + changes


def _commits(commits: dict[str, int]) -> str:
    if len(commits) == 1:
        return f"commit {next(iter(commits))[:HASH_LENGTH]}"
    return "commits " + ", ".join(f"{commit[:HASH_LENGTH]} ({jobs} jobs)" for commit, jobs in commits.items())


def processor(study: str, results: StudyResults) -> str:
    """Return the processor on which a study ran, as its manifest names it."""
    path = results.folder / study / "manifest.json"
    model = json.loads(path.read_text("utf-8"))["cpu"]["model"] if path.is_file() else None
    return model or "unknown processor"


def _pairs(values: dict[str, str], between: str) -> str:
    return ", ".join(f"{name}{between}{value}" for name, value in values.items())
