"""Runs studies: all their jobs through one pool, searches included, then their tables and reports.

What jobs and tables need is imported only where something is left to do: asking again takes no time.
"""

from collections import deque
from collections.abc import Sequence
from pathlib import Path

from quadlab.studies.content import is_told
from quadlab.studies.files import configuration_hash
from quadlab.studies.open_study import open_study
from quadlab.studies.progress import StudyProgress
from quadlab.trials.result import TrialStatus


def run_studies(names: Sequence[str], results: Path, workers: int, progress: StudyProgress) -> int:
    """Run what is missing of some studies, write tables that tell something else, and return the number of errors.

    Args:
        names: of the studies.
        results: folder of all results.
        workers: processes at a time.
        progress: told about every job.

    Raises:
        ConfigurationError: if a study does not exist, or something in it is wrong; nothing was run then.
        OSError: if files cannot be written.
    """
    configuration = configuration_hash()
    studies = [open_study(name, results, configuration) for name in names]
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
        if not is_told(study):
            from quadlab.studies.tables import write_tables  # noqa: PLC0415

            write_tables(study)
    return sum(row["status"] == TrialStatus.ERROR for study in studies for _, row in study.rows)
