"""What a study leaves: the table of all jobs, the limits found, provenance and a report."""

from collections.abc import Sequence
from typing import Any

import pandas as pd

from quadlab.paths import checkout_dir
from quadlab.studies.boundary import BoundarySearch
from quadlab.studies.condition import Condition
from quadlab.studies.content import CONTENT, content_hash
from quadlab.studies.open_study import OpenStudy
from quadlab.studies.report import study_report
from quadlab.trials.files import write_json, write_text
from quadlab.trials.manifest import git_state, installed_packages, lock_hash, processor, thread_environment

Rows = Sequence[tuple[Condition, dict[str, Any]]]
Searches = Sequence[tuple[Condition, BoundarySearch]]
FLOAT_FORMAT = "%.6g"


def write_tables(study: OpenStudy) -> None:
    """Write ``table.csv``, ``limits.csv`` if something was searched for, ``report.md`` and, last, ``manifest.json``."""
    folder, table, limits = study.folder, job_table(study.rows), limit_table(study.searches)
    write_text(folder.table, table.to_csv(index=False, float_format=FLOAT_FORMAT))
    if len(limits):
        write_text(folder.limits, limits.to_csv(index=False, float_format=FLOAT_FORMAT))
    else:
        folder.limits.unlink(missing_ok=True)  # of an earlier form of the study
    write_text(folder.report, study_report(study.config, table, limits))
    write_json(folder.manifest, {**study_manifest(study, table), CONTENT: content_hash(study)})


def job_table(rows: Rows) -> pd.DataFrame:
    """Return one row a job: its levels, then its numbers."""
    return pd.DataFrame([{**job.levels, **{k: v for k, v in row.items() if k not in job.levels}} for job, row in rows])


def limit_table(searches: Searches) -> pd.DataFrame:
    """Return one row a search: its levels, the largest value survived, and how sure that is.

    ``highest`` is the last value of the grid. ``unknown`` says why a limit was not found; without such, it is left out.
    """
    return pd.DataFrame(
        [
            {
                **condition.levels,
                "key": search.config.label,
                "limit": search.limit,
                "highest": search.grid[-1],
                "step": search.config.step,
                "probes": len(search.outcomes),
                "monotone": search.monotone,
                **({"unknown": search.unknown} if search.unknown else {}),
            }
            for condition, search in searches
        ]
    )


def study_manifest(study: OpenStudy, table: pd.DataFrame) -> dict[str, Any]:
    """Return what the numbers of a study's table depend on."""
    commits = table["commit"].dropna().value_counts().to_dict() if "commit" in table else {}
    return {
        "jobs": len(table),
        "commits": {str(commit): int(count) for commit, count in commits.items()},
        "git": git_state(checkout_dir()),
        "configuration_sha256": study.configuration,
        "lock_sha256": lock_hash(checkout_dir()),
        "cpu": processor(),
        "environment": thread_environment(),
        "packages": installed_packages(),
    }
