"""Runs studies: all their jobs through one pool, searches included, then their tables and reports.

What jobs and tables need is imported only where something is left to do: asking again takes no time.
"""

from collections import deque
from collections.abc import Sequence
from pathlib import Path

from quadlab.studies.open_study import OpenStudy, open_study
from quadlab.studies.progress import StudyProgress
from quadlab.trials.result import TrialStatus


def run_studies(names: Sequence[str], results: Path, workers: int, progress: StudyProgress) -> int:
    """Run what is missing of some studies, write their tables, and return how many jobs ended in an error.

    Args:
        names: of the studies.
        results: folder of all results.
        workers: processes at a time.
        progress: told about every job.

    Raises:
        ConfigurationError: if a study does not exist, or something in it is wrong; nothing was run then.
        OSError: if files cannot be written.
    """
    studies = [open_study(name, results) for name in names]
    queue = deque((study, *job) for study in studies for job in study.open_jobs(progress))
    if queue:
        from quadlab.studies.check import check_jobs  # noqa: PLC0415
        from quadlab.studies.work_off import work_off  # noqa: PLC0415

        progress.say(f"checking {len(queue)} jobs")
        check_jobs(queue)
        for study, _, _ in queue:
            study.folder.path.mkdir(parents=True, exist_ok=True)
        work_off(queue, workers, progress)
    for study in studies:
        if study.changed or not study.folder.table.is_file():
            _write_tables(study)
    everything = [row for study in studies for condition in study.conditions for _, row in condition.rows]
    return sum(row["status"] == TrialStatus.ERROR for row in everything)


def _write_tables(study: OpenStudy) -> None:
    from quadlab.studies.tables import write_tables  # noqa: PLC0415

    rows = [row for condition in study.conditions for row in condition.rows]
    searches = [(c.condition, c.search) for c in study.conditions if c.search is not None]
    write_tables(study.config, study.folder, rows, searches)
