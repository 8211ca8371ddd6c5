"""Draws artefacts side by side, each in a process of its own."""

from collections.abc import Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from paper_figures.gallery import ArtefactScript, artefact_scripts, draw_artefact
from quadlab.analysis.study_results import StudyResults
from quadlab.errors import QuadlabError
from quadlab.sweeps.job import Job, JobStatus, Outcome
from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.pool import run_pool


@dataclass(frozen=True)
class Drawing:
    """What came of an artefact.

    Attributes:
        script: of the artefact.
        paths: of what was written.
        problem: why nothing was; empty if it was.
    """

    script: ArtefactScript
    paths: tuple[Path, ...]
    problem: str = ""


def drawings(
    scripts: Sequence[ArtefactScript], results: StudyResults, folder: Path, workers: int
) -> Generator[Drawing, None, None]:
    """Draw all ``scripts`` into ``folder``, ``workers`` at a time, and yield what came of each as it is done.

    A single one is drawn in this process. Leaving the loop early ends the others.
    """
    if min(workers, len(scripts)) <= 1:
        yield from (drawing(script, results, folder) for script in scripts)
        return
    jobs = [Job(script.name, drawing, (script, results, folder)) for script in scripts]
    pool = PoolConfig(workers=workers, memory_limit_gib=None, time_limit_s=None)
    with closing(run_pool(jobs, pool, preloads=[Job("importing", artefact_scripts, ([],))])) as outcomes:
        for outcome in outcomes:
            yield _drawing(scripts[outcome.number], outcome)


def drawing(script: ArtefactScript, results: StudyResults, folder: Path) -> Drawing:
    """Draw an artefact; that its results are missing or of another form is an outcome."""
    try:
        return Drawing(script, tuple(draw_artefact(script, results, folder)))
    except QuadlabError as error:
        return Drawing(script, (), str(error))


def _drawing(script: ArtefactScript, outcome: Outcome) -> Drawing:
    """Return the drawing, or why its process ended without one, with what it printed."""
    if outcome.status is JobStatus.RETURNED:
        found: Drawing = outcome.value
        return found
    return Drawing(script, (), f"{outcome.reason}\n{outcome.output}".rstrip())
