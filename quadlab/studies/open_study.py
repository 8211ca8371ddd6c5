"""Studies under way: which of their jobs were done before, and which comes next."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from quadlab.errors import ConfigurationError
from quadlab.studies.boundary import BoundarySearch
from quadlab.studies.condition import Condition, conditions
from quadlab.studies.config import StudyConfig, load_study
from quadlab.studies.consistency import study_problems
from quadlab.studies.files import StudyFolder
from quadlab.studies.progress import StudyProgress
from quadlab.studies.rows import FAILURE, Row
from quadlab.studies.work import Work, remembered
from quadlab.trials.result import TrialStatus


@dataclass
class OpenCondition:
    """A condition under way: one job, or a search that asks for one after the other."""

    condition: Condition
    search: BoundarySearch | None
    rows: list[tuple[Condition, Row]] = field(default_factory=list)

    @property
    def levels_of_parts(self) -> tuple[object, ...]:
        """Which planner, controller and estimator it asks for by name; they are loaded once for all jobs."""
        return tuple(self.condition.levels.get(part) for part in ("planner", "controller", "estimator"))

    def next_job(self) -> Condition | None:
        """Return the job to do next; None if there is none left."""
        if self.search is None:
            return None if self.rows else self.condition
        value = self.search.next_value()
        return None if value is None else self.condition.probe(value)

    def take(self, job: Condition, row: Row) -> None:
        """Take in the row of a job."""
        self.rows.append((job, row))
        if self.search is not None:
            self._record(self.search, float(job.levels[self.search.config.label]), row)

    @staticmethod
    def _record(search: BoundarySearch, value: float, row: Row) -> None:
        """Take in what came of a value; an error of the program says nothing about the robot."""
        if row["status"] == TrialStatus.ERROR:
            search.give_up(f"error at {value:g}: {row.get(FAILURE)}")
        else:
            search.record(value, row["status"] == TrialStatus.COMPLETED)


@dataclass
class OpenStudy:
    """A study under way.

    Attributes:
        name: of its file.
        config: what that says.
        folder: for what it leaves.
        configuration: see ``configuration_hash``, of when it began.
        conditions: all of them.
    """

    name: str
    config: StudyConfig
    folder: StudyFolder
    configuration: str
    conditions: list[OpenCondition]

    @property
    def rows(self) -> list[tuple[Condition, Row]]:
        """All jobs with their rows so far, in the order of the conditions."""
        return [row for condition in self.conditions for row in condition.rows]

    @property
    def searches(self) -> list[tuple[Condition, BoundarySearch]]:
        """What is searched for, each with the condition in which it is."""
        return [(condition.condition, condition.search) for condition in self.conditions if condition.search]

    def open_jobs(self, progress: StudyProgress) -> Iterator[tuple[OpenCondition, Condition]]:
        """Yield the first job of each condition that was not done before."""
        for condition in self.conditions:
            job = self.advance(condition, progress)
            if job is not None:
                yield condition, job

    def advance(self, condition: OpenCondition, progress: StudyProgress) -> Condition | None:
        """Return the next job of a condition that has to be done, taking in those that were done before."""
        while (job := condition.next_job()) is not None:
            progress.expect(1)
            row = remembered(self.work(job))
            if row is None:
                return job
            condition.take(job, row)
            progress.skip()
        return None

    def job_name(self, job: Condition) -> str:
        """Return what people read of a job."""
        return f"{self.name} {', '.join(str(level) for level in job.levels.values())}"

    def work(self, job: Condition) -> Work:
        """Return what a process needs to do a job."""
        return Work(self.config, self.folder, job, self.configuration)


PendingJob: TypeAlias = tuple[OpenStudy, OpenCondition, Condition]
"""A job with what it belongs to."""


def open_study(name: str, results: Path, configuration: str) -> OpenStudy:
    """Return a study that is about to be run.

    Args:
        name: of its file.
        results: folder of all results.
        configuration: see ``configuration_hash``.

    Raises:
        ConfigurationError: if there is no such study, or something in it is wrong.
    """
    config = load_study(name)
    found = conditions(config)
    problems = [f"study/{name}.yaml: {problem}" for problem in study_problems(config, found)]
    if problems:
        raise ConfigurationError("\n".join(problems))
    opened = [OpenCondition(c, BoundarySearch(c.search) if c.search else None) for c in found]
    return OpenStudy(name, config, StudyFolder(results / name), configuration, opened)
