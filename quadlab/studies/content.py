"""Whether the tables of a study tell what its file and its rows say now; asking imports nothing heavy."""

import hashlib
import json

from quadlab.studies.files import StudyFolder
from quadlab.studies.open_study import OpenStudy

CONTENT = "content_sha256"
"""Key of the manifest: hash of what the tables beside it were made of."""


def content_hash(study: OpenStudy) -> str:
    """Return a hash of all that tables and manifest tell: the study's file, its jobs, their rows, the configuration."""
    jobs = [(job.identifier, job.levels, row) for job, row in study.rows]
    return hashlib.sha256(json.dumps([study.config.model_dump_json(), study.configuration, jobs]).encode()).hexdigest()


def is_told(study: OpenStudy) -> bool:
    """Whether all tables are there and were made of what the study is now."""
    folder = study.folder
    there = folder.table.is_file() and folder.report.is_file() and folder.limits.is_file() is bool(study.searches)
    return there and _told_hash(folder) == content_hash(study)


def _told_hash(folder: StudyFolder) -> object:
    """Return the hash in the manifest; None if there is none."""
    try:
        manifest = json.loads(folder.manifest.read_text(encoding="utf-8"))
    except (FileNotFoundError, ValueError):  # missing or damaged: it is written anew
        return None
    return manifest.get(CONTENT) if isinstance(manifest, dict) else None
