"""A job of a study: what it is, and whether it was done before."""

from dataclasses import dataclass

from quadlab.studies.condition import Condition
from quadlab.studies.config import StudyConfig, TraceConfig
from quadlab.studies.files import StudyFolder, read_row, trace_files
from quadlab.studies.rows import DIRECTORY, Row
from quadlab.trials.result import RESULT_FILE, TrialStatus

_WITH_PLAN = ("solved", *set(TrialStatus) - {TrialStatus.PLANNING_FAILED, TrialStatus.ERROR})


@dataclass(frozen=True)
class Work:
    """A job to be done.

    Attributes:
        study: that it belongs to.
        folder: of the study.
        condition: to run.
        configuration: hash of what the YAML files said when the study began.
    """

    study: StudyConfig
    folder: StudyFolder
    condition: Condition
    configuration: str

    @property
    def settings(self) -> str:
        """What the row depends on besides the overrides."""
        return f"{self.study.job} {self.configuration} {self.study.kept_hash}"

    @property
    def traces(self) -> list[TraceConfig]:
        """Which curves are kept of it."""
        return [trace for trace in self.study.traces if self.condition.matches(trace.where)]

    @property
    def plans(self) -> list[str]:
        """Under which names its plan is kept."""
        return [name for name, where in self.study.plans.items() if self.condition.matches(where)]


def has_plan(row: Row) -> bool:
    """Whether the job came so far that there are curves and a plan to keep."""
    return row["status"] in _WITH_PLAN


def remembered(work: Work) -> Row | None:
    """Return the row of a job that was done before and whose files are all there, else None."""
    row = read_row(work.folder, work.condition.identifier, work.settings)
    if row is None or row["status"] == TrialStatus.ERROR:
        return None
    needed = []
    if has_plan(row):
        needed += [path for trace in work.traces for path in trace_files(trace, work.folder)]
        needed += [work.folder.plan(name) for name in work.plans]
    if work.study.job == "trial":
        needed.append(work.folder.path / row[DIRECTORY] / RESULT_FILE)
    return row if all(path.is_file() for path in needed) else None
